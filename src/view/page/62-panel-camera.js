// The panel of the camera: where it is, its lens, cameras of the file, undo, and the camera as text.

{
  const { slider, select, vector, button, group, section } = alhazen.controls;
  const { element } = alhazen;

  alhazen.cameraPanel = (app) => {
    const { camera } = app, panel = section("camera", "Camera");
    const list = select({ label: "From the file", onChange: (value) => value !== "" &&
      app.connection.send({ type: "select_camera", camera: Number(value) }) });
    const change = (part) => (value) => camera.change({ [part]: value });
    const position = vector({ label: "Position", onChange: change("position") });
    const target = vector({ label: "Target", onChange: change("target") });
    const up = vector({ label: "Up", onChange: change("up") });
    // While a slider is dragged all its changes are one step to undo, and pictures may be coarse.
    const lens = (options, part) => slider({ ...options, bound: true,
      onInput: (value) => (camera.begin(), camera.change({ [part]: value })), onChange: () => camera.end() });
    const fov = lens({ label: "Field of view", min: 5, max: 150, step: 0.5, initial: 45, unit: "degrees over the shorter side" }, "fov");
    let apertureRange = 0;
    let aperture = null, focus = null;
    const lensRows = element("div", { className: "stack" });
    const buildLens = () => {
      if (apertureRange === camera.radius) return;
      apertureRange = camera.radius;
      aperture = lens({ label: "Aperture", min: 0, max: 0.05 * camera.radius, step: 0.0001 * camera.radius,
        unit: "radius of the lens in scene units" }, "aperture");
      focus = lens({ label: "Focus", min: 0.001 * camera.radius, max: 20 * camera.radius, log: true,
        initial: camera.radius, unit: "distance in scene units" }, "focus");
      lensRows.replaceChildren(aperture.element, focus.element);
    };
    const undo = button("Undo", () => camera.undo()), redo = button("Redo", () => camera.redo());
    const text = element("output", { className: "command", "aria-label": "Command that renders this view" });

    panel.body.append(list.element, position.element, target.element, up.element, fov.element, lensRows,
      group("Camera", undo, redo, button("Reset", () => app.resetCamera())),
      text,
      group("Camera as text",
        button("Copy as --look-at", () => app.copyCommand(), { title: "a whole command of alhazen render" }),
        button("Copy as pbrt", () => app.copyPbrt())));

    const update = () => {
      if (!camera.camera) return;
      buildLens();
      position.set(camera.camera.position);
      target.set(camera.camera.target);
      up.set(camera.camera.up);
      if (camera.camera.fov !== null) fov.set(camera.camera.fov);
      fov.element.hidden = camera.camera.fov === null;
      aperture.set(camera.camera.aperture ?? 0);
      focus.set(camera.camera.focus ?? camera.distance);
      undo.disabled = !camera.canUndo;
      redo.disabled = !camera.canRedo;
      text.textContent = app.command();
    };
    camera.on("changed", alhazen.oncePerFrame(update));
    app.picture.on("changed", alhazen.oncePerFrame(update));
    app.on("scene", (scene) => {
      list.setChoices([["", "choose a camera"], ...scene.cameras.map((name, i) => [String(i), name || `camera ${i}`])]);
      list.element.hidden = scene.cameras.length < 2;
      panel.element.hidden = scene.read_only;
      update();
    });
    return panel;
  };
}
