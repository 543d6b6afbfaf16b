// The panel of the render: how far it is, its noise, how many samples it takes, at what resolution; and what the program
// had to say.

{
  const { number, select, button, group, fact, row, section } = alhazen.controls;
  const { element, duration, shortNumber } = alhazen;
  const svg = (tag, attributes) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    return made;
  };

  /// The estimated error over samples, both on logarithmic axes.
  const curvePlot = () => {
    const [width, height, left, bottom] = [280, 96, 34, 16];
    const plot = svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "curve", role: "img", "aria-label": "Noise over samples" });
    const figure = element("figure", { className: "plot", hidden: true },
      element("figcaption", { textContent: "Estimated relative error over samples" }), plot);
    const set = (curve) => {
      const points = (curve ?? []).filter(([samples, error]) => samples > 0 && error > 0 && Number.isFinite(error));
      figure.hidden = points.length < 2;
      if (figure.hidden) return;
      const logs = points.map(([samples, error]) => [Math.log2(samples), Math.log10(error)]);
      const bounds = (values) => [Math.min(...values), Math.max(...values)];
      const [x0, x1] = bounds(logs.map((point) => point[0]));
      let [y0, y1] = bounds(logs.map((point) => point[1]));
      if (y1 - y0 < 0.3) [y0, y1] = [y0 - 0.15, y1 + 0.15];
      const x = (value) => left + ((value - x0) / Math.max(x1 - x0, 1e-9)) * (width - left - 8);
      const y = (value) => 8 + ((y1 - value) / (y1 - y0)) * (height - bottom - 12);
      const parts = [];
      const label = (text, at, down, anchor) => {
        const made = svg("text", { x: at, y: down, "text-anchor": anchor });
        made.textContent = text;
        parts.push(made);
      };
      const percent = (log) => `${shortNumber(100 * 10 ** log, 2)}%`;
      for (const value of [y0, (y0 + y1) / 2, y1]) {
        parts.push(svg("line", { x1: left, x2: width - 8, y1: y(value), y2: y(value), class: "grid" }));
        label(percent(value), left - 5, y(value) + 3, "end");
      }
      label(shortNumber(2 ** x0, 3), x(x0), height - 3, "start");
      label(`${shortNumber(2 ** x1, 4)} samples`, x(x1), height - 3, "end");
      parts.push(svg("polyline", { points: logs.map((point) => `${x(point[0])},${y(point[1])}`).join(" "), class: "line" }));
      const last = logs[logs.length - 1];
      parts.push(svg("circle", { cx: x(last[0]), cy: y(last[1]), r: 2.5, class: "point" }));
      plot.replaceChildren(...parts);
    };
    return { element: figure, set };
  };

  alhazen.renderPanel = (app) => {
    const panel = section("render", "Render");
    const facts = Object.fromEntries(Object.entries({ activity: "Activity", samples: "Samples", seconds: "Time taken",
      remaining: "Time left", error: "Noise", size: "Resolution" }).map(([key, name]) => [key, fact(name)]));
    const table = element("dl", { className: "facts" }, ...Object.values(facts).flatMap((each) => each.elements));
    const plot = curvePlot();
    const samples = number({ label: "Samples to take", min: 1, max: 1 << 20, step: 1, digits: 7,
      onChange: (value) => app.connection.send({ type: "samples", samples: Math.round(value) }) });
    const samplesRow = row("Samples", samples.element.id, samples.element);
    const size = select({ label: "Resolution", onChange: (value) => app.chooseSize(value) });
    const pause = button("Pause", () => app.togglePause());
    const stop = button("Stop and write the image", () => app.confirmStop(), { className: "button danger" });
    const save = button("Write the image so far", () => app.connection.send({ type: "save" }));
    const log = element("ul", { className: "log", "aria-label": "Messages of the program" });
    const messages = element("div", { className: "stack", hidden: true }, element("h3", { textContent: "Messages" }), log);
    const writable = group("Render", pause), readOnly = group("Render", save, stop);
    panel.body.append(table, plot.element, samplesRow, size.element, writable, readOnly, messages);

    const showSizes = () => {
      const [width, height] = app.fileSize, image = app.picture.image?.header;
      const window = app.windowSize();
      const current = image ? `${image.full_width}x${image.full_height}` : `${width}x${height}`;
      const pairs = [[`${width}x${height}`, `${width} × ${height} (at first)`],
        [`${Math.ceil(width / 2)}x${Math.ceil(height / 2)}`, `${Math.ceil(width / 2)} × ${Math.ceil(height / 2)} (half)`],
        [`${2 * width}x${2 * height}`, `${2 * width} × ${2 * height} (double)`],
        ["window", `${window[0]} × ${window[1]} (fills the window)`]];
      if (!pairs.some(([key, name]) => key === current || name.startsWith(current.replace("x", " × "))))
        pairs.push([current, current.replace("x", " × ")]);
      size.setChoices(pairs);
      if (document.activeElement !== size.control) size.set(pairs.some(([key]) => key === current) ? current : "window");
    };

    app.on("scene", (scene) => {
      writable.hidden = samplesRow.hidden = size.element.hidden = scene.read_only;
      readOnly.hidden = !scene.read_only;
      samples.set(scene.samples);
      showSizes();
    });
    app.on("status", (status) => {
      const names = { rendering: "rendering", paused: "paused", done: "done", reading: "reading the scene",
        building: "building", failed: "failed" };
      facts.activity.set((names[status.activity] ?? status.activity) + (status.denoising ? ", denoising" : ""));
      facts.samples.set(`${shortNumber(status.samples ?? 0, 5)} of ${status.samples_total ?? "–"} per pixel`);
      facts.seconds.set(duration(status.seconds));
      facts.remaining.set(status.remaining === null || status.remaining === undefined ? "–" : duration(status.remaining));
      facts.error.set(status.error > 0 ? `${shortNumber(100 * status.error, 3)} %` : "–");
      const image = app.picture.image?.header;
      if (image) facts.size.set(`${image.full_width} × ${image.full_height}${image.step > 1 ? `, at 1/${image.step}` : ""}`);
      plot.set(status.curve);
      if (status.samples_total) samples.set(status.samples_total);
      pause.textContent = status.activity === "paused" ? "Go on" : "Pause";
      showSizes();
    });
    app.on("log", (text) => {
      messages.hidden = false;
      log.append(element("li", { textContent: text }));
      while (log.children.length > 100) log.firstChild.remove();
    });
    return panel;
  };
}
