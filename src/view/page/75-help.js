// Keys: what each does, the dialog that lists them, and the notices at the edge of the picture.

{
  const { element } = alhazen;

  /// [keys as they are shown, what it does, and where: edit, read or both]
  const mouse = [
    ["Drag", "turn about the target (orbit), look around (fly), move the picture (inspect)"],
    ["Right drag, Shift + drag", "move the camera sideways"],
    ["Wheel", "distance to the target; zoom in inspect; speed in fly"],
    ["Ctrl + wheel, ctrl + drag", "zoom and move the picture in every mode"],
    ["Click", "name what is there; double click: look at it and focus on it"],
    ["Touch", "one finger turns, two move and change the distance"],
  ];

  /// Keys that work wherever the keyboard is, except in fields. `shift` and `ctrl` are part of what is pressed.
  const bindings = (app) => {
    const { picture, viewport, camera, input } = app;
    const stops = (by) => picture.set({ exposure: Math.round(10 * (picture.settings.exposure + by)) / 10 });
    const next = (list, current, by = 1) => list[(list.indexOf(current) + by + list.length) % list.length];
    return [
      ["O", "orbit", "Camera", () => input.setMode("orbit"), "edit"],
      ["G", "fly: W A S D forward and sideways, Q E down and up", "Camera", () => input.setMode("fly"), "edit"],
      ["Z", "inspect: move and zoom the picture", "Picture", () => input.setMode("inspect")],
      ["Arrows", "turn the camera; with shift, move it", "Camera", null, "edit"],
      ["+ / -", "nearer and farther", "Camera", null, "edit"],
      ["Enter", "name what is in the middle; with shift, focus on it", "Camera", null, "edit"],
      ["Ctrl+Z", "undo a move of the camera", "Camera", () => camera.undo(), "edit"],
      ["Ctrl+Shift+Z", "redo it", "Camera", () => camera.redo(), "edit"],
      ["R", "camera as it was at first", "Camera", () => app.resetCamera(), "edit"],
      ["K", "copy as --look-at", "Camera", () => app.copyCommand(), "edit"],
      ["E", "half a stop brighter", "Picture", () => stops(0.5)],
      ["Shift+E", "half a stop darker; also [ and ]", "Picture", () => stops(-0.5)],
      ["[", null, "Picture", () => stops(-0.5)],
      ["]", null, "Picture", () => stops(0.5)],
      ["0", "exposure 0", "Picture", () => picture.set({ exposure: 0 })],
      ["T", "next tone map", "Picture", () => picture.set({ toneMap: next(alhazen.colour.toneMaps, picture.settings.toneMap) })],
      ["L", "next layer", "Picture", () => app.chooseLayer(next(app.layerNames(), picture.settings.layer))],
      ["Shift+L", "layer before", "Picture", () => app.chooseLayer(next(app.layerNames(), picture.settings.layer, -1))],
      ["C", "next channels", "Picture", () =>
        picture.set({ channel: next(["rgb", "r", "g", "b", "a", "luminance"], picture.settings.channel) })],
      ["X", "false colour", "Picture", () => picture.set({ falseColour: !picture.settings.falseColour })],
      ["H", "marks of NaN, infinite, negative", "Picture", () => picture.set({ markUnusual: !picture.settings.markUnusual })],
      ["J", "marks of what is clipped", "Picture", () => picture.set({ markClipped: !picture.settings.markClipped })],
      ["V", "compare layers with a split", "Picture", () => app.toggleSplit()],
      ["F", "the whole picture", "Picture", () => viewport.fit()],
      ["1", "one to one", "Picture", () => viewport.oneToOne()],
      ["D", "denoise when at rest", "Render", () => app.setDenoise(!app.denoises), "edit"],
      ["P", "pause and go on", "Render", () => app.togglePause(), "edit"],
      ["S", "save PNG", "Render", () => app.savePng()],
      ["Shift+S", "save EXR", "Render", () => app.saveExr()],
      ["N", "hide and show the panels", "Page", () => app.togglePanels()],
      ["?", "this list", "Page", () => app.help.show()],
    ];
  };

  const nameOf = (event) => {
    const key = event.key.length === 1 ? event.key.toUpperCase() : event.key;
    const shift = event.shiftKey && /^[A-Z]$/.test(key) ? "Shift+" : "";
    return `${event.ctrlKey || event.metaKey ? "Ctrl+" : ""}${shift}${key}`;
  };

  alhazen.Help = class {
    constructor(app) {
      this.app = app;
      this.dialog = alhazen.byId("help");
      this.bindings = bindings(app);
      addEventListener("keydown", (event) => this.#press(event));
      this.dialog.addEventListener("click", (event) => event.target === this.dialog && this.dialog.close());
    }

    #press(event) {
      if (event.altKey || event.defaultPrevented || this.dialog.open) return;
      if (/^(INPUT|TEXTAREA|SELECT)$/.test(event.target.tagName) && !/^(range|checkbox)$/.test(event.target.type)) return;
      const name = nameOf(event);
      const binding = this.bindings.find(([keys, , , action]) => action && keys === name);
      if (!binding || (binding[4] === "edit" && this.app.isReadOnly)) return;
      event.preventDefault();
      binding[3]();
    }

    show() {
      const keys = (text) => element("dt", {}, ...text.split(" / ").flatMap((part, i) =>
        [...(i ? [" "] : []), element("kbd", { textContent: part })]));
      const plain = (text) => element("dt", { textContent: text });
      const part = (title, rows, term = keys) => element("section", {}, element("h3", { textContent: title }),
        element("dl", {}, ...rows.flatMap(([name, what]) => [term(name), element("dd", { textContent: what })])));
      const listed = this.bindings.filter(([, what, , , where]) => what && !(where === "edit" && this.app.isReadOnly));
      const topics = [...new Set(listed.map((binding) => binding[2]))];
      const close = element("button", { type: "button", className: "button", textContent: "Close", onclick: () => this.dialog.close() });
      this.dialog.replaceChildren(element("header", {}, element("h2", { id: "help-title", textContent: "Mouse and keys" }), close),
        element("div", { className: "help-parts" }, part("Mouse", mouse, plain),
          ...topics.map((topic) => part(topic, listed.filter((binding) => binding[2] === topic)))));
      if (!this.dialog.open) this.dialog.showModal();
    }
  };

  /// Short sentences at the lower edge of the picture. One that says `lasts` stays until it is replaced or cleared.
  alhazen.notices = {
    lasting: new Map(),
    say(text, { seconds = 4, key = null, isError = false, action = null } = {}) {
      const box = alhazen.byId("notices");
      if (key) this.clear(key);
      const notice = element("div", { className: isError ? "notice error" : "notice" }, element("span", { textContent: text }));
      if (action) notice.append(element("button", { type: "button", className: "button small", textContent: action.label,
        onclick: action.run }));
      box.append(notice);
      while (box.children.length > 4) box.firstChild.remove();
      if (key) this.lasting.set(key, notice);
      if (Number.isFinite(seconds)) setTimeout(() => notice.remove(), 1000 * seconds);
    },
    clear(key) {
      this.lasting.get(key)?.remove();
      this.lasting.delete(key);
    },
  };
}
