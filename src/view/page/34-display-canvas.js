// Shows layers without WebGL2: each pixel of the picture is computed here, and a 2D canvas scales them.

{
  const { toneMap, srgbEncode, luminance, mapColour } = alhazen.colour;
  const clamp01 = (value) => Math.min(Math.max(value, 0), 1);

  const numberColour = (value) => {
    if (!(value > 0)) return [0.09, 0.09, 0.09];
    const hue = (value * 0.61803398875) % 1, shade = 0.55 + 0.4 * ((value * 0.7548776662) % 1);
    return [0, 0.33, 0.67].map((shift) => shade * (0.55 + 0.45 * Math.cos(2 * Math.PI * (hue + shift))));
  };

  /// sRGB from 0 to 1 of the values of a pixel: what the shader computes as well.
  const shownColour = (values, layer, view) => {
    const [low, high] = layer.range, range = Math.max(high - low, 1e-30);
    if (layer.kind === "number") return numberColour(values[0]);
    if (layer.kind === "scalar") {
      const v = clamp01((values[0] - low) / range);
      return layer.map === "grey" ? [v, v, v] : mapColour(layer.map, v);
    }
    let rgb = [values[0], values[1] ?? 0, values[2] ?? 0];
    const single = ["r", "g", "b", "a"].indexOf(view.channel);
    if (view.channel === "luminance" && layer.kind !== "vector") rgb = rgb.fill(luminance(rgb));
    else if (single >= 0) rgb = rgb.fill(values[single] ?? (single === 3 ? 1 : 0));
    if (layer.kind === "vector") return rgb.map((value) => clamp01((value - low) / range));
    if (layer.kind === "colour") return rgb.map((value) => srgbEncode(clamp01(value)));
    rgb = rgb.map((value) => value * 2 ** view.exposure);
    if (view.falseColour) {
      const l = luminance(rgb);
      return l > 0 ? mapColour("viridis", (Math.log2(l / 0.18) - low) / range) : [0, 0, 0];
    }
    return toneMap(rgb, view.toneMap).map(srgbEncode);
  };

  const marked = (rgb, values, layer, view, stripe) => {
    if (view.markUnusual) {
      if (values.some(Number.isNaN)) return stripe ? [1, 0, 1] : [0.25, 0, 0.25];
      if (values.some((value) => !Number.isFinite(value))) return stripe ? [1, 0.85, 0] : [0.3, 0.25, 0];
      if (layer.kind !== "vector" && values.some((value) => value < 0)) return stripe ? [0.1, 0.5, 1] : [0, 0.1, 0.3];
    }
    const clipped = view.markClipped && layer.kind === "radiance" && !view.falseColour;
    return clipped && stripe && rgb.some((value) => value >= 254.5 / 255) ? [1, 0.2, 0.15] : rgb;
  };

  alhazen.CanvasDisplay = class {
    #context;
    #converted = new Map();  // from layers to { image, key, canvas }

    constructor(canvas) {
      this.name = "2D canvas";
      this.canvas = canvas;
      this.#context = canvas.getContext("2d");
    }

    get largestSize() {
      return 8192;
    }

    release() {}

    #convert(layer, view) {
      const { image } = layer;
      const key = JSON.stringify([layer.kind, layer.range, layer.map, view.channel, view.exposure, view.falseColour,
        view.toneMap, view.markUnusual, view.markClipped]);
      const known = this.#converted.get(image.header.layer);
      if (known?.image === image && known.key === key) return known.canvas;
      const canvas = alhazen.element("canvas", { width: image.width, height: image.height });
      const context = canvas.getContext("2d"), pixels = context.createImageData(image.width, image.height);
      for (let y = 0, i = 0; y < image.height; ++y) {
        for (let x = 0; x < image.width; ++x, i += 4) {
          const values = image.values(x, y).slice(0, 4);
          const rgb = marked(shownColour(values, layer, view), values, layer, view, (x + y) % 4 < 2);
          for (let c = 0; c < 3; ++c) pixels.data[i + c] = Math.floor(255 * rgb[c] + 0.5);
          pixels.data[i + 3] = 255;
        }
      }
      context.putImageData(pixels, 0, 0);
      this.#converted.set(image.header.layer, { image, key, canvas });
      return canvas;
    }

    #drawLayer(layer, view, left, right) {
      const context = this.#context, { image } = layer, { header } = image;
      const [x, y] = view.offset, size = view.scale * image.step;
      context.save();
      context.beginPath();
      context.rect(left, 0, right - left, this.canvas.height);
      context.clip();
      context.beginPath();
      context.rect(x, y, header.full_width * view.scale, header.full_height * view.scale);
      context.clip();
      context.imageSmoothingEnabled = image.step > 1 || view.smooth || view.scale < 1;
      context.drawImage(this.#convert(layer, view), x + header.x * view.scale, y + header.y * view.scale,
        image.width * size, image.height * size);
      context.restore();
    }

    draw(view) {
      this.#context.clearRect(0, 0, this.canvas.width, this.canvas.height);
      if (!view.a) return;
      this.#drawLayer(view.a, view, 0, view.b ? view.split : this.canvas.width);
      if (view.b) this.#drawLayer(view.b, view, view.split, this.canvas.width);
    }
  };
}
