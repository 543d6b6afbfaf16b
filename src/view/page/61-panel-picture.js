// The panel of the picture: layer, exposure, tone map, false colour, marks, comparison and files.

{
  const { slider, select, checkbox, segments, button, group, number, section } = alhazen.controls;
  const { element } = alhazen;
  const names = { color: "colour", noisy: "noisy", denoised: "denoised", flip: "FLIP (error)", reference: "reference" };
  const nameOf = (layer) => names[layer] ?? layer.replaceAll("_", " ");
  const toneMapNames = [["none", "None (sRGB)"], ["reinhard", "Reinhard"], ["filmic", "Filmic"], ["aces", "ACES"], ["agx", "AgX"]];

  const swatches = () => element("dl", { className: "legend", "aria-label": "Marks" },
    ...[["nan", "NaN"], ["infinite", "infinite"], ["negative", "negative"]].flatMap(([key, name]) =>
      [element("dt", { className: `swatch ${key}` }), element("dd", { textContent: name })]));

  alhazen.picturePanel = (app) => {
    const { picture } = app, panel = section("picture", "Picture");
    const layer = select({ label: "Layer", onChange: (value) => app.chooseLayer(value) });
    const exposure = slider({ label: "Exposure", min: -10, max: 10, step: 0.1, unit: "stops", digits: 4,
      onInput: (value) => picture.set({ exposure: value }) });
    const toneMap = select({ label: "Tone map", choices: toneMapNames, onChange: (value) => picture.set({ toneMap: value }) });
    const channel = segments({ label: "Channels", className: "wide", choices: [["rgb", "RGB"], ["r", "R"], ["g", "G"], ["b", "B"],
      ["a", "A"], ["luminance", "Y", "luminance"]], onChange: (value) => picture.set({ channel: value }) });
    const stops = checkbox({ label: "False colour: luminance in stops", onChange: (value) => picture.set({ falseColour: value }) });
    const map = select({ label: "Colours", choices: [["viridis", "Viridis"], ["magma", "Magma"], ["grey", "Grey"]],
      onChange: (value) => picture.image && (picture.maps.set(picture.image.header.layer, value), picture.set({})) });

    const rangeKey = () => (picture.image && picture.showsStops(picture.image) ? "stops" : picture.image?.header.layer);
    const setRange = (i, value) => {
      const range = [...picture.rangeOf(picture.image)];
      range[i] = value;
      picture.ranges.set(rangeKey(), range);
      picture.set({});
    };
    const low = number({ label: "Lowest value", onChange: (value) => setRange(0, value), digits: 4 });
    const high = number({ label: "Highest value", onChange: (value) => setRange(1, value), digits: 4 });
    const ramp = element("canvas", { className: "ramp", width: 128, height: 1, "aria-hidden": "true" });
    const range = element("div", { className: "row range", role: "group", "aria-label": "Range of the colours" },
      low.element, ramp, high.element,
      button("Auto", () => (picture.ranges.delete(rangeKey()), picture.set({})), { className: "button small" }));

    const unusual = checkbox({ label: "Mark NaN, infinite, negative", onChange: (value) => picture.set({ markUnusual: value }) });
    const clipped = checkbox({ label: "Mark what is clipped", title: "stripes where a channel reaches white",
      onChange: (value) => picture.set({ markClipped: value }) });
    const denoise = checkbox({ label: "Denoise when at rest", onChange: (value) => app.setDenoise(value) });
    const other = select({ label: "Compare", onChange: (value) => app.chooseOther(value || null) });
    const split = slider({ label: "Split", min: 0, max: 100, step: 1, initial: 50, bound: true, unit: "%",
      onInput: (value) => picture.set({ split: value / 100 }) });
    const precision = checkbox({ label: "Exact values (32-bit float)", title: "values of pixels are otherwise half-floats",
      onChange: (value) => app.setExact(value) });

    panel.body.append(layer.element, exposure.element,
      group("Exposure", button("Auto", () => picture.set({ exposure: picture.suitableExposure() })),
        button("0 stops", () => picture.set({ exposure: 0 }))),
      toneMap.element, channel.element, stops.element, map.element, range, unusual.element, swatches(), clipped.element,
      denoise.element, other.element, split.element, precision.element,
      group("Files", button("Save PNG", () => app.savePng(), { title: "what is shown, at full resolution" }),
        button("Save EXR", () => app.saveExr(), { title: "linear values and layers" })));

    const paintRamp = (colours) => {
      const context = ramp.getContext("2d");
      for (let x = 0; x < 128; ++x) {
        const v = x / 127, rgb = colours === "grey" ? [v, v, v] : alhazen.colour.mapColour(colours, v);
        context.fillStyle = `rgb(${rgb.map((c) => Math.round(255 * c)).join(" ")})`;
        context.fillRect(x, 0, 1, 1);
      }
    };

    const update = () => {
      const { settings, image } = picture;
      const pairs = app.layerNames().map((name) => [name, nameOf(name)]);
      layer.setChoices(pairs);
      layer.set(settings.layer);
      other.setChoices([["", "nothing"], ...pairs.filter(([name]) => name !== settings.layer)]);
      other.set(settings.other ?? "");
      exposure.set(settings.exposure);
      toneMap.set(settings.toneMap);
      channel.set(settings.channel);
      stops.set(settings.falseColour);
      unusual.set(settings.markUnusual);
      clipped.set(settings.markClipped);
      denoise.set(app.denoises);
      precision.set(app.exact);
      split.set(Math.round(100 * settings.split));
      split.element.hidden = !settings.other;
      denoise.element.hidden = app.isReadOnly;
      const kind = image ? picture.kindOf(image) : "radiance", scalar = kind === "scalar";
      const isStops = image !== null && picture.showsStops(image);
      for (const each of [exposure, toneMap, stops]) each.element.hidden = kind !== "radiance";
      exposure.element.nextSibling.hidden = kind !== "radiance";
      toneMap.element.hidden ||= isStops;
      channel.element.hidden = scalar || kind === "number";
      map.element.hidden = !scalar;
      range.hidden = !(scalar || kind === "vector" || isStops);
      ramp.hidden = kind === "vector";
      if (!range.hidden) {
        const [from, to] = picture.rangeOf(image);
        low.set(from);
        high.set(to);
        const colours = scalar ? picture.mapOf(image) : "viridis";
        map.set(colours);
        paintRamp(colours);
      }
    };
    picture.on("changed", update);
    const later = alhazen.throttled(update, 200);
    picture.on("drawn", (fresh) => fresh.length && later());
    app.on("scene", update);
    app.on("options", update);
    return panel;
  };

  alhazen.layerName = nameOf;
}
