// The panel of what was clicked: its object, material and place in the file, the material's fields, and all changes.

{
  const { slider, checkbox, button, group, fact, row, section } = alhazen.controls;
  const { element, shortNumber } = alhazen;
  const { srgbEncode, srgbDecode } = alhazen.colour;
  const list = (vector) => vector.map((value) => shortNumber(value, 5)).join(", ");

  const toHex = (linear) => `#${linear.map((value) =>
    Math.round(255 * srgbEncode(alhazen.clamp(value, 0, 1))).toString(16).padStart(2, "0")).join("")}`;
  const fromHex = (hex) => [1, 3, 5].map((i) => Number(srgbDecode(parseInt(hex.slice(i, i + 2), 16) / 255).toPrecision(5)));

  const colourField = (field, onInput) => {
    const input = element("input", { type: "color", className: "colour", value: toHex(field.value), id: `field-${field.name}` });
    const text = element("span", { className: "value", textContent: list(field.value) });
    input.oninput = () => {
      const value = fromHex(input.value);
      text.textContent = list(value);
      onInput(value);
    };
    return row(field.label, input.id, input, text);
  };

  /// The control of a field of a material.
  const fieldControl = (field, onInput) => {
    if (field.kind === "colour") return colourField(field, onInput);
    if (field.kind === "bool") {
      const check = checkbox({ label: field.label, onChange: onInput });
      check.set(field.value);
      return check.element;
    }
    const max = field.max ?? Math.max(1, 4 * field.value), min = field.min ?? 0;
    const control = slider({ label: field.label, min, max, step: (max - min) / 200, initial: field.value, onInput, digits: 4,
      bound: field.max !== undefined && field.max !== null });
    return control.element;
  };

  alhazen.objectPanel = (app) => {
    const panel = section("object", "Object");
    const hint = element("p", { className: "hint", textContent: "Click something to see what it is." });
    const facts = Object.fromEntries(Object.entries({ object: "Object", instance: "Instance", material: "Material",
      where: "Defined at", position: "Position", distance: "Distance", normal: "Normal" }).map(([key, name]) => [key, fact(name)]));
    const table = element("dl", { className: "facts", hidden: true }, ...Object.values(facts).flatMap((each) => each.elements));
    const fields = element("div", { className: "stack" });
    const changes = element("ol", { className: "changes", "aria-label": "Changes" });
    let listed = [];
    const changed = element("div", { className: "stack", hidden: true }, element("h3", { textContent: "Changes" }), changes,
      group("Changes", button("Copy", () => alhazen.copyText(listed.join("\n"), "the list of changes"))));
    panel.body.append(hint, table, fields, changed);

    let pending = null;
    const send = alhazen.oncePerFrame(() => {
      app.connection.send({ type: "material", material: pending.material, values: pending.values });
      pending = null;
    });
    const change = (material, name, value) => {
      if (pending && pending.material !== material) app.connection.send({ type: "material", ...pending });
      pending = { material, values: { ...(pending?.material === material ? pending.values : {}), [name]: value } };
      send();
    };

    const showFields = (picked) => {
      const controls = (picked.fields ?? []).map((field) => {
        const control = fieldControl(field, (value) => change(picked.material, field.name, value));
        if (field.textured) control.append(element("span", { className: "tag", textContent: "textured",
          title: "an image or a function sets it; a change replaces that" }));
        return control;
      });
      fields.replaceChildren(...(controls.length ? [element("h3", { textContent: `${picked.kind ?? ""} material` }), ...controls] : []));
    };

    app.on("picked", (picked) => {
      const found = picked.object !== null || picked.position;
      hint.hidden = Boolean(found);
      hint.textContent = found ? "" : "Nothing is there: the ray leaves the scene.";
      table.hidden = !found;
      const show = (key, text) => {
        for (const part of facts[key].elements) part.hidden = !text;
        facts[key].set(text ?? "");
      };
      show("object", picked.object ?? "without a name");
      show("instance", picked.instance ? String(picked.instance) : null);
      show("material", picked.material_name ? `${picked.material_name}${picked.kind ? ` (${picked.kind})` : ""}` : null);
      show("where", picked.where);
      show("position", picked.position ? list(picked.position) : null);
      show("distance", Number.isFinite(picked.distance) ? shortNumber(picked.distance, 5) : null);
      show("normal", picked.normal ? list(picked.normal) : null);
      showFields(found ? picked : {});
    });
    app.on("changes", (lines) => {
      listed = lines;
      changed.hidden = lines.length === 0;
      changes.replaceChildren(...lines.map((line) => element("li", { textContent: line })));
    });
    app.on("scene", (scene) => (panel.element.hidden = scene.read_only));
    return panel;
  };
}
