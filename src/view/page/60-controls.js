// The parts of panels: sections, rows, sliders, numbers, choices and buttons. Each returns its element and, where it has
// a value, `set(value)`, which shows a value without telling the listener.

{
  const { element, shortNumber, clamp } = alhazen;
  let count = 0;
  const newId = () => `control-${++count}`;

  /// A part of the panels with a heading that hides and shows it.
  const section = (name, title) => {
    const body = element("div", { className: "section-body", id: `body-${name}` });
    const button = element("button", { type: "button", className: "section-title", textContent: title, "aria-expanded": "true",
      "aria-controls": body.id });
    const whole = element("section", { className: "section", id: `section-${name}` }, element("h2", {}, button), body);
    button.onclick = () => {
      const open = button.getAttribute("aria-expanded") !== "true";
      button.setAttribute("aria-expanded", String(open));
      body.hidden = !open;
    };
    return { element: whole, body, name, title };
  };

  const row = (label, id, ...children) =>
    element("div", { className: "row" }, element("label", { htmlFor: id, textContent: label }), ...children);

  const button = (label, onclick, attributes = {}) =>
    element("button", { type: "button", className: "button", textContent: label, onclick, ...attributes });

  const group = (label, ...children) => element("div", { className: "buttons", role: "group", "aria-label": label }, ...children);

  /// A number that can be typed. Enter and leaving it set it; arrow keys change its last digits.
  const number = ({ label, id = newId(), min = -Infinity, max = Infinity, step = 0.1, digits = 5, onChange, unit }) => {
    const input = element("input", { type: "text", inputMode: "decimal", id, className: "number", autocomplete: "off",
      spellcheck: false, "aria-label": label });
    if (unit) input.title = unit;
    let current = 0;
    // As much as fits; who types gets all digits.
    const shown = () => {
      if (current === null) return "";
      const text = shortNumber(current, digits);
      return text.length > 7 ? shortNumber(current, 3) : text;
    };
    const show = (value) => {
      current = value;
      if (document.activeElement !== input) input.value = shown();
    };
    input.onfocus = () => {
      input.value = current === null ? "" : shortNumber(current, 9);
      input.select();
    };
    input.onblur = () => (input.value = shown());
    const commit = (value) => {
      if (!Number.isFinite(value)) return show(current);
      const bounded = clamp(value, min, max);
      if (bounded !== current) onChange(current = bounded);
    };
    input.onchange = () => commit(input.value.trim() === "" ? NaN : Number(input.value.replace(",", ".")));
    input.onkeydown = (event) => {
      const by = { ArrowUp: 1, ArrowDown: -1 }[event.key];
      if (event.key === "Escape") input.value = shortNumber(current ?? 0, 9), input.blur();
      if (event.key === "Enter") input.blur();
      if (!by) return;
      event.preventDefault();
      commit(Number(((current ?? 0) + by * step * (event.shiftKey ? 10 : 1)).toPrecision(12)));
      input.value = shortNumber(current ?? 0, 9);
    };
    return { element: input, set: show };
  };

  /// A slider with a number beside it. `log`: equal ways are equal factors. A double click restores `initial`.
  const slider = ({ label, min, max, step = 0.01, initial = 0, log = false, bound = false, digits = 4, unit, onInput, onChange }) => {
    const to = log ? Math.log : (x) => x, from = log ? Math.exp : (x) => x;
    const id = newId();
    const range = element("input", { type: "range", id, className: "slider", min: to(min), max: to(max),
      step: log ? (to(max) - to(min)) / 400 : step, "aria-label": label });
    const finish = (value) => onChange?.(value);
    const field = number({ label: `${label}, as a number`, min: bound ? min : -Infinity, max: bound ? max : Infinity, step,
      digits, unit, onChange: (value) => (paint(value), onInput(value), finish(value)) });
    const paint = (value) => {
      range.value = to(clamp(value, min, max));
      const part = (to(clamp(value, min, max)) - to(min)) / (to(max) - to(min));
      range.style.setProperty("--part", `${100 * part}%`);
      range.setAttribute("aria-valuetext", `${shortNumber(value, 4)}${unit ? ` ${unit}` : ""}`);
    };
    const set = (value) => (paint(value), field.set(value));
    const read = () => Number((log ? from(Number(range.value)).toPrecision(3) : Number(range.value).toPrecision(10)));
    range.oninput = () => {
      const value = read();
      set(value);
      onInput(value);
    };
    range.onchange = () => finish(read());
    range.ondblclick = () => (set(initial), onInput(initial), finish(initial));
    set(initial);
    const whole = row(label, id, range, field.element);
    whole.classList.add("with-slider");
    return { element: whole, set, range };
  };

  /// `choices`: [value, name] pairs.
  const select = ({ label, choices = [], onChange }) => {
    const id = newId(), control = element("select", { id, className: "select" });
    let known = "";
    const setChoices = (pairs) => {
      if (JSON.stringify(pairs) === known) return;
      known = JSON.stringify(pairs);
      const value = control.value;
      control.replaceChildren(...pairs.map(([key, name]) => element("option", { value: key, textContent: name })));
      if (pairs.some(([key]) => key === value)) control.value = value;
    };
    setChoices(choices);
    control.onchange = () => onChange(control.value);
    return { element: row(label, id, control), control, set: (value) => (control.value = value), setChoices };
  };

  const checkbox = ({ label, onChange, title }) => {
    const input = element("input", { type: "checkbox", className: "check" });
    input.onchange = () => onChange(input.checked);
    const whole = element("label", { className: "row check-row", title }, input, element("span", { textContent: label }));
    return { element: whole, input, set: (value) => (input.checked = value) };
  };

  /// Buttons of which one is pressed.
  const segments = ({ label, choices, onChange, className = "" }) => {
    const buttons = choices.map(([value, name, title]) =>
      element("button", { type: "button", className: "segment", textContent: name, title, "aria-pressed": "false",
        onclick: () => onChange(value) }));
    const whole = element("div", { className: `segments ${className}`, role: "group", "aria-label": label }, ...buttons);
    const set = (value) =>
      buttons.forEach((each, i) => each.setAttribute("aria-pressed", String(choices[i][0] === value)));
    return { element: whole, set };
  };

  /// Three numbers.
  const vector = ({ label, onChange, step = 0.1, names = ["x", "y", "z"] }) => {
    let current = [0, 0, 0];
    const fields = names.map((name, i) =>
      number({ label: `${label} ${name}`, step, onChange: (value) => {
        current = current.with ? current.with(i, value) : Object.assign([...current], { [i]: value });
        onChange(current);
      } }));
    const whole = element("div", { className: "row vector", role: "group", "aria-label": label },
      element("span", { className: "label", textContent: label }), ...fields.map((field) => field.element));
    return { element: whole, set: (value) => (current = [...value], fields.forEach((field, i) => field.set(value[i]))) };
  };

  /// A line of a name and a text that can be selected.
  const fact = (name) => {
    const value = element("dd");
    return { elements: [element("dt", { textContent: name }), value], set: (text) => (value.textContent = text) };
  };

  alhazen.controls = { section, row, button, group, number, slider, select, checkbox, segments, vector, fact };
}
