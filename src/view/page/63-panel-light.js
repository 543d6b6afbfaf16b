// The panel of the light: rotation and strength of the environment, and a factor on all other lights.

{
  const { slider, button, group, section } = alhazen.controls;

  alhazen.lightPanel = (app) => {
    const panel = section("light", "Light");
    const values = app.light;
    const send = alhazen.oncePerFrame(() => app.connection.send({ type: "environment", ...values }));
    let changed = -Infinity;
    const change = (part) => (value) => {
      changed = performance.now();
      values[part] = value;
      send();
    };
    const rotation = slider({ label: "Rotation", min: -180, max: 180, step: 1, unit: "degrees", onInput: change("rotation") });
    const strength = slider({ label: "Environment", min: 0.01, max: 100, log: true, initial: 1, unit: "factor",
      onInput: change("strength") });
    const scale = slider({ label: "Other lights", min: 0.01, max: 100, log: true, initial: 1, unit: "factor",
      onInput: change("light_scale") });
    const show = () => {
      rotation.set(values.rotation);
      strength.set(values.strength);
      scale.set(values.light_scale);
    };
    panel.body.append(rotation.element, strength.element, scale.element,
      group("Light", button("As in the file", () => {
        Object.assign(values, { rotation: 0, strength: 1, light_scale: 1 });
        show();
        changed = performance.now();
        send();
      })));
    app.on("scene", (scene) => {
      panel.element.hidden = !scene.environment || scene.read_only;
      // While a slider is dragged, what comes back is older than what it shows.
      if (performance.now() - changed < 800) return;
      Object.assign(values, scene.environment ?? {});
      show();
    });
    return panel;
  };
}
