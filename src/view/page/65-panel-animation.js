// The panel of the animation: a slider of time, and playing. Playing goes on with real time; frames that the renderer is
// too slow for are left out.

{
  const { slider, button, group, section } = alhazen.controls;

  alhazen.animationPanel = (app) => {
    const panel = section("animation", "Animation");
    let range = null, time = 0, control = null, playing = 0;
    const send = alhazen.oncePerFrame(() => app.connection.send({ type: "time", time }));
    const setTime = (value) => {
      time = app.time = value;
      control.set(Number(value.toFixed(4)));
      send();
    };
    const play = button("Play", () => (playing ? stop() : start()));
    const stop = () => {
      playing = 0;
      play.textContent = "Play";
    };
    const start = () => {
      const run = (playing = performance.now()), from = time, length = range.end - range.start;
      play.textContent = "Pause";
      const step = (now) => {
        if (playing !== run || !app.connection.isOpen) return;
        const at = from - range.start + (now - run) / 1000;
        const frame = Math.floor((at % length) * range.fps) / range.fps;
        if (range.start + frame !== time) setTime(range.start + frame);
        requestAnimationFrame(step);
      };
      requestAnimationFrame(step);
    };
    const stepBy = (frames) => {
      stop();
      setTime(alhazen.clamp(time + frames / range.fps, range.start, range.end));
    };
    panel.body.append(group("Animation", button("Back", () => stepBy(-1), { title: "one frame back" }), play,
      button("Forward", () => stepBy(1), { title: "one frame forward" })));
    app.on("scene", (scene) => {
      const next = scene.read_only ? null : scene.animation;
      panel.element.hidden = !next;
      if (JSON.stringify(next) === JSON.stringify(range)) return;
      stop();
      range = next;
      control?.element.remove();
      if (!range) return;
      time = scene.time ?? range.start;
      range.fps = range.fps > 0 ? range.fps : 24;
      control = slider({ label: "Time", min: range.start, max: range.end, step: 1 / range.fps, initial: time, bound: true,
        unit: "seconds", onInput: (value) => (stop(), setTime(value)) });
      panel.body.prepend(control.element);
    });
    return panel;
  };
}
