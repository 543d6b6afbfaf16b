// Puts the parts together: what comes from the program goes to them, and what they ask for goes to the program.

{
  const { element, byId, notices } = alhazen;

  /// Emits: scene, status, picked, changes, log, and options when what is asked of the program changes.
  class App extends alhazen.Events {
    scene = null;
    isReadOnly = false;
    denoises = false;
    exact = false;
    status = {};
    light = { rotation: 0, strength: 1, light_scale: 1 };
    time = null;  // of the animation, if the page has set it
    fileSize = [1, 1];
    #paused = false;
    #pickId = 0;
    #focusPick = 0;
    #wanted = "";

    constructor() {
      super();
      this.connection = new alhazen.Connection(location.href);
      this.decoder = new alhazen.FrameDecoder();
      this.viewport = new alhazen.Viewport(byId("stage"));
      this.picture = new alhazen.Picture(this.#makeDisplay(), this.viewport);
      this.overlay = new alhazen.Overlay(byId("overlay"), this.picture, this.viewport);
      this.meter = new alhazen.Meter();
      this.camera = new alhazen.Camera((camera, moving, id) => {
        if (this.connection.send({ type: "camera", camera, moving, id })) this.meter.cameraSent(id);
      });
      this.input = new alhazen.Input(byId("surface"), this.camera, this.viewport);
      this.help = new alhazen.Help(this);
      this.#build();
      this.#listen();
      this.connection.connect();
    }

    #makeDisplay() {
      const canvas = byId("picture");
      try {
        return new alhazen.WebGLDisplay(canvas, () => this.picture.redraw());
      } catch (error) {
        console.warn(error.message);
        notices.say("Without WebGL2 the picture is drawn more slowly.", { seconds: 8 });
        const other = canvas.cloneNode();  // a canvas keeps the first kind of context that it was asked for
        canvas.replaceWith(other);
        return new alhazen.CanvasDisplay(other);
      }
    }

    // --- The page ---

    #build() {
      alhazen.bars.buildTools(this);
      alhazen.bars.buildStats(this);
      alhazen.bars.buildReadout(this);
      alhazen.buildSplit(this);
      const panels = [alhazen.picturePanel, alhazen.cameraPanel, alhazen.lightPanel, alhazen.objectPanel,
        alhazen.animationPanel, alhazen.renderPanel].map((build) => build(this));
      byId("sections").append(...panels.map((panel) => panel.element));
      this.panels = panels;
      this.#buildTabs();
      this.input.setMode("orbit");
      document.body.classList.add("without-scene");
    }

    /// On narrow pages one panel is shown at a time, below the picture.
    #buildTabs() {
      const tabs = this.panels.map((panel) => element("button", { type: "button", role: "tab", className: "tab",
        textContent: panel.title, "aria-controls": panel.element.id, onclick: () => choose(panel.name, true) }));
      const choose = (name, toggles = false) => {
        const isOpen = !byId("panels").classList.contains("closed");
        const closes = toggles && this.tab === name && isOpen;
        if (toggles) byId("panels").classList.toggle("closed", closes);
        this.tab = name;
        this.panels.forEach((panel, i) => {
          panel.element.classList.toggle("chosen", panel.name === name);
          tabs[i].setAttribute("aria-selected", String(panel.name === name && !closes));
        });
      };
      byId("tabs").append(...tabs);
      choose("picture");
      this.on("scene", () => {
        this.panels.forEach((panel, i) => (tabs[i].hidden = panel.element.hidden));
        if (this.panels.find((panel) => panel.name === this.tab).element.hidden) choose("picture");
      });
    }

    togglePanels() {
      document.body.classList.toggle("without-panels");
    }

    readoutHint() {
      if (!this.scene) return "";
      return matchMedia("(pointer: coarse)").matches ? "touch the picture to turn the camera"
        : this.input.mode === "inspect" ? "values of the pixel under the pointer" : "drag to turn, double click to focus, ? for keys";
    }

    // --- What comes in ---

    #listen() {
      const { connection, decoder, picture, viewport, camera, input } = this;
      connection.on("open", () => this.#opened());
      connection.on("closed", ({ wait }) => this.#closed(wait));
      connection.on("text", (message) => this.#receive(message));
      connection.on("binary", (buffer) => decoder.receive(buffer));
      decoder.on("image", (image) => picture.receive(image));
      decoder.on("skipped", (header) => connection.send({ type: "ack", frame: header.frame }));
      decoder.on("broken", alhazen.throttled(() => connection.send({ type: "hello" }), 1000));
      picture.on("drawn", (images) => this.#drawn(images));
      picture.on("changed", () => this.#askForLayers());
      viewport.on("changed", () => this.#resized());
      camera.on("changed", () => this.overlay.draw());
      input.on("pick", (pick) => this.#pick(pick));
      this.#resized();
    }

    #opened() {
      notices.clear("connection");
      document.body.classList.remove("disconnected");
      this.decoder.reset();
      this.#wanted = JSON.stringify([["color"], false]);  // what a program sends unless it is asked for something else
      this.connection.send({ type: "hello" });
      if (this.denoises) this.connection.send({ type: "denoise", on: true });
      this.#askForLayers();
    }

    #closed(wait) {
      document.body.classList.add("disconnected");
      byId("waiting-text").textContent = "Connecting";
      notices.say(`No connection to the program. Trying again${wait > 1500 ? ` in ${Math.round(wait / 1000)} s` : ""}.`,
        { seconds: Infinity, key: "connection", action: { label: "Try now", run: () => this.connection.connect() } });
    }

    #receive(message) {
      const handlers = {
        scene: () => this.#setScene(message),
        camera: () => this.camera.receive(message.camera),
        status: () => this.#setStatus(message),
        picked: () => this.#picked(message),
        changes: () => this.emit("changes", message.changes),
        log: () => this.emit("log", message.message),
        error: () => (message.fatal ? this.#fail(message.message) : notices.say(message.message, { isError: true, seconds: 10 })),
      };
      handlers[message.type]?.();
    }

    #setScene(scene) {
      const isFirst = !this.scene;
      this.scene = scene;
      this.isReadOnly = scene.read_only;
      if (isFirst) {
        this.fileSize = scene.size;
        this.picture.set({ exposure: scene.exposure ?? 0, toneMap: scene.tone_map || "none" });
        this.viewport.setPictureSize(...scene.size);
        this.input.isReadOnly = scene.read_only;
        this.input.setMode(scene.read_only ? "inspect" : "orbit");
      }
      byId("failure").hidden = true;
      byId("scene-name").textContent = scene.name.replace(/^.*[/\\]/, "");
      byId("scene-name").title = scene.name;
      document.title = `${scene.name} – Alhazen`;
      document.body.classList.toggle("read-only", scene.read_only);
      document.body.classList.remove("without-scene");
      this.camera.setScene(scene);
      this.emit("scene", scene);
    }

    #setStatus(status) {
      this.status = status;
      this.#paused = status.activity === "paused";
      const waits = { reading: "Reading the scene", building: "Building the scene", failed: "" };
      byId("waiting-text").textContent = waits[status.activity] ?? "Waiting for the first picture";
      this.emit("status", status);
    }

    #fail(text) {
      byId("failure").hidden = false;
      byId("failure-text").textContent = text;
      byId("waiting").hidden = true;
      if (!this.scene) byId("scene-name").textContent = "failed";
    }

    #drawn(images) {
      this.overlay.draw();
      if (images.length === 0) return;
      byId("waiting").hidden = true;
      byId("failure").hidden = true;
      for (const image of images) this.connection.send({ type: "ack", frame: image.header.frame });
      this.meter.drawn(images);
    }

    #resized() {
      const { width, height, pixelRatio } = this.viewport, { canvas } = this.picture.display;
      const [w, h] = [Math.round(width * pixelRatio), Math.round(height * pixelRatio)];
      if (canvas.width !== w || canvas.height !== h) {
        [canvas.width, canvas.height] = [w, h];
        this.picture.display.draw(this.picture.view());  // a canvas whose size changes is empty until it is drawn
      }
      this.picture.redraw();
    }

    // --- What is asked for ---

    layerNames() {
      const names = new Set((this.scene?.layers ?? [{ name: "color" }]).map((layer) => layer.name));
      for (const name of this.picture.images.keys()) names.add(name);
      if (this.denoises) names.add("denoised");
      else names.delete("denoised");
      return [...names];
    }

    #askForLayers() {
      const { layer, other } = this.picture.settings;
      const layers = [...new Set([layer, other].filter(Boolean))];
      // The colour is shown until there is a denoised picture of the same view.
      if (layers.includes("denoised") && !layers.includes("color")) layers.push("color");
      const wanted = JSON.stringify([layers, this.exact]);
      if (wanted === this.#wanted || !this.connection.isOpen) return;
      this.#wanted = wanted;
      this.connection.send({ type: "layers", layers, exact: this.exact });
    }

    chooseLayer(layer) {
      const { other } = this.picture.settings;
      this.picture.set({ layer, other: other === layer ? null : other });
    }

    chooseOther(other) {
      this.picture.set({ other });
    }

    /// The split compares what can be compared best: denoised and noisy, or the picture and its reference.
    toggleSplit() {
      if (this.picture.settings.other) return this.chooseOther(null);
      const names = this.layerNames(), { layer } = this.picture.settings;
      const other = ["color", "reference", "denoised", ...names].find((name) => name !== layer && names.includes(name));
      if (other) this.chooseOther(other);
    }

    setExact(exact) {
      this.exact = exact;
      this.#askForLayers();
      this.emit("options");
    }

    setDenoise(on) {
      this.denoises = on;
      this.connection.send({ type: "denoise", on });
      const { layer, other } = this.picture.settings;
      if (on && layer === "color") this.picture.set({ layer: "denoised", other: other === "denoised" ? null : other });
      if (!on && layer === "denoised") this.picture.set({ layer: "color", other: other === "color" ? null : other });
      if (!on && other === "denoised") this.chooseOther(null);
      this.emit("options");
    }

    togglePause() {
      this.connection.send({ type: "pause", paused: !this.#paused });
    }

    confirmStop() {
      notices.say("Stop the render and write the image as it is?", { seconds: 8, key: "stop",
        action: { label: "Stop", run: () => (this.connection.send({ type: "stop" }), notices.clear("stop")) } });
    }

    windowSize() {
      const { width, height, pixelRatio } = this.viewport;
      return [width, height].map((side) => Math.max(16, Math.floor(side * pixelRatio)));
    }

    chooseSize(value) {
      const [width, height] = value === "window" ? this.windowSize() : value.split("x").map(Number);
      this.connection.send({ type: "size", width, height });
    }

    resetCamera() {
      this.connection.send({ type: "reset" });
    }

    #pick({ x, y, focus }) {
      const id = ++this.#pickId;
      if (focus) this.#focusPick = id;
      this.overlay.setMark(x, y);
      this.connection.send({ type: "pick", x, y, id });
    }

    #picked(picked) {
      if (picked.id < this.#pickId) return;
      if (picked.id === this.#focusPick && picked.position) this.camera.focusOn(picked.position);
      this.emit("picked", picked);
    }

    // --- What leaves the page ---

    command() {
      if (!this.scene || !this.camera.camera) return "";
      const header = this.picture.image?.header, { exposure, toneMap } = this.picture.settings;
      return alhazen.cameraText.command(this.scene, {
        camera: this.camera.camera, size: header ? [header.full_width, header.full_height] : this.scene.size,
        samples: this.scene.samples, light: this.light, time: this.time, exposure, toneMap,
      });
    }

    copyCommand() {
      alhazen.copyText(this.command(), "a command that renders this view");
    }

    copyPbrt() {
      if (this.camera.camera) alhazen.copyText(alhazen.cameraText.pbrt(this.scene, this.camera.camera), "LookAt and Camera");
    }

    #fileName(ending) {
      const base = (this.scene?.name ?? "view").replace(/^.*\//, "").replace(/\.[^.]*$/, "") || "view";
      const { layer } = this.picture.settings;
      return `${base}${layer === "color" || ending === "exr" ? "" : `-${layer}`}.${ending}`;
    }

    #offer(blob, name) {
      const link = element("a", { href: URL.createObjectURL(blob), download: name });
      document.body.append(link);
      link.click();
      link.remove();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    }

    async savePng() {
      const blob = await this.picture.png();
      if (!blob) return notices.say("There is no picture yet.");
      this.#offer(blob, this.#fileName("png"));
    }

    async saveExr() {
      const answer = await fetch("save.exr").catch(() => null);
      if (!answer?.ok) {
        const reason = answer ? (await answer.text()).trim() : "There is no connection to the program.";
        return notices.say(reason || "The image cannot be saved.", { isError: true, seconds: 8 });
      }
      this.#offer(await answer.blob(), this.#fileName("exr"));
    }
  }

  alhazen.app = new App();
}
