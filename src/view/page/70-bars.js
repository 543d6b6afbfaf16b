// The bars above and below the picture: tools, figures of the render, and values under the pointer.

{
  const { element, shortNumber, duration } = alhazen;
  const { segments, button } = alhazen.controls;

  /// Frames drawn in the last second, and milliseconds from sending a camera to drawing the first picture of it.
  class Meter {
    framesPerSecond = 0;
    milliseconds = null;
    #drawn = [];
    #sent = new Map();

    cameraSent(id) {
      this.#sent.set(id, performance.now());
    }

    drawn(images) {
      const now = performance.now();
      if (images.length) this.#drawn.push(now);
      for (const { header } of images) {
        const sent = this.#sent.get(header.camera_id);
        if (sent === undefined) continue;
        this.milliseconds = now - sent;
        for (const id of this.#sent.keys()) if (id <= header.camera_id) this.#sent.delete(id);
      }
      this.update(now);
    }

    update(now = performance.now()) {
      this.#drawn = this.#drawn.filter((time) => now - time < 1000);
      this.framesPerSecond = this.#drawn.length;
    }
  }

  const stat = (name, title) => {
    const value = element("span", { className: "stat-value", textContent: "–" });
    const whole = element("span", { className: "stat", title }, value, element("span", { className: "stat-name", textContent: name }));
    return { element: whole, set: (text) => (value.textContent = text), rename: (text) => (whole.lastChild.textContent = text) };
  };

  const buildStats = (app) => {
    const bar = alhazen.byId("stats"), progress = alhazen.byId("progress"), meter = app.meter;
    const activity = element("span", { className: "activity" });
    const stats = {
      samples: stat("spp", "samples per pixel so far"), fps: stat("fps", "pictures drawn in the last second"),
      ms: stat("ms", "from a move of the camera to the first picture of it"), rays: stat("Mray/s", "million rays a second"),
      viewers: stat("viewers", "pages that are connected"),
    };
    bar.append(activity, ...Object.values(stats).map((each) => each.element));
    const refresh = () => {
      meter.update();
      stats.fps.set(String(meter.framesPerSecond));
      stats.ms.set(meter.milliseconds === null ? "–" : String(Math.round(meter.milliseconds)));
    };
    app.picture.on("drawn", refresh);
    setInterval(refresh, 500);
    app.on("scene", (scene) => (stats.ms.element.hidden = scene.read_only));
    app.on("status", (status) => {
      const left = status.remaining > 0 && status.activity === "rendering" ? `, ${duration(status.remaining)} left` : "";
      activity.textContent = status.activity + left;
      bar.dataset.activity = status.activity;
      stats.samples.set(shortNumber(status.samples ?? 0, 4));
      stats.rays.set(status.mrays > 0 ? shortNumber(status.mrays, 3) : "–");
      stats.viewers.set(String(status.viewers ?? 1));
      stats.viewers.rename(status.viewers === 1 ? "viewer" : "viewers");
      const part = status.samples_total > 0 ? alhazen.clamp(status.samples / status.samples_total, 0, 1) : 0;
      progress.style.setProperty("--part", `${100 * part}%`);
      progress.setAttribute("aria-valuenow", String(Math.round(100 * part)));
      progress.dataset.activity = status.activity;
    });
  };

  const buildTools = (app) => {
    const mode = segments({ label: "What dragging does", choices: [["orbit", "Orbit", "O: drag turns about the target"],
      ["fly", "Fly", "G: W A S D Q E move, drag looks around"], ["inspect", "Inspect", "Z: drag and wheel move the picture"]],
    onChange: (value) => (app.input.setMode(value), alhazen.byId("surface").focus()) });
    const zoom = element("output", { className: "zoom", "aria-label": "Zoom" });
    const fit = button("Fit", () => app.viewport.fit(), { title: "F: the whole picture", className: "button plain" });
    const one = button("1:1", () => app.viewport.oneToOne(), { title: "1: a pixel of the picture is one of the display",
      className: "button plain" });
    const help = button("?", () => app.help.show(), { title: "keys", "aria-label": "Keyboard shortcuts",
      className: "button plain" });
    const panels = button("Panels", () => app.togglePanels(), { title: "N: hides and shows the panels",
      className: "button plain only-wide" });
    alhazen.byId("tools").append(mode.element, fit, one, zoom, panels, help);
    app.input.on("mode", mode.set);
    mode.set(app.input.mode);
    app.on("scene", (scene) => (mode.element.hidden = scene.read_only));
    app.viewport.on("changed", () =>
      (zoom.textContent = `${shortNumber(100 * app.viewport.scale * app.viewport.pixelRatio, 3)}%`));
  };

  const buildReadout = (app) => {
    const place = element("span", { className: "place" }), values = element("span", { className: "linear" });
    const swatch = element("span", { className: "swatch", "aria-hidden": "true" }), bytes = element("span", { className: "bytes" });
    const precision = element("span", { className: "precision" }), shown = element("span", { className: "shown" });
    alhazen.byId("readout").append(place, values, swatch, bytes, precision, shown);
    let at = null;
    const update = () => {
      const { picture, viewport } = app, { settings } = picture;
      const inB = at && settings.other && at[0] > settings.split * viewport.width;
      const image = (inB ? picture.otherImage : null) ?? picture.image;
      shown.textContent = image ? `${alhazen.layerName(image.header.layer)}${settings.exposure && picture.kindOf(image) ===
        "radiance" ? `, ${settings.exposure > 0 ? "+" : "−"}${shortNumber(Math.abs(settings.exposure), 3)} stops` : ""}` : "";
      const point = at && image && viewport.contains(at) ? viewport.toPicture(at).map(Math.floor) : null;
      const pixel = point && image.pixelAt(point[0] + 0.5, point[1] + 0.5);
      for (const each of [values, swatch, bytes, precision]) each.hidden = !pixel;
      place.textContent = pixel ? `${point[0]}, ${point[1]}` : app.readoutHint();
      place.classList.toggle("hint", !pixel);
      if (!pixel) return;
      const numbers = image.values(...pixel), digits = image.isFloat ? 9 : 4;
      values.replaceChildren(...numbers.slice(0, 8).map((value, i) => element("span", {
        className: `channel ${numbers.length >= 3 ? "rgb"[i] ?? "" : ""}`, textContent: shortNumber(value, digits),
        title: image.channels[i] })));
      const isColour = ["radiance", "colour"].includes(picture.kindOf(image)) && numbers.length >= 3;
      swatch.hidden = bytes.hidden = !isColour;
      if (isColour) {
        const plain = picture.kindOf(image) === "colour";
        const rgb = alhazen.colour.displayBytes(numbers.slice(0, 3), plain ? 0 : settings.exposure, plain ? "none" : settings.toneMap);
        swatch.style.backgroundColor = `rgb(${rgb.join(" ")})`;
        bytes.textContent = `sRGB ${rgb.join(" ")}  #${rgb.map((value) => value.toString(16).padStart(2, "0")).join("")}`;
      }
      precision.textContent = `${image.isFloat ? "float" : "half"}${image.step > 1 ? `, 1/${image.step}` : ""}`;
    };
    const later = alhazen.oncePerFrame(update);
    app.input.on("hover", (point) => {
      at = point;
      later();
    });
    for (const source of [app.viewport, app.picture]) source.on("changed", later);
    app.picture.on("drawn", later);
    app.on("scene", later);
  };

  alhazen.Meter = Meter;
  alhazen.bars = { buildStats, buildTools, buildReadout };
}
