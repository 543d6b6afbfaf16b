// What is shown and how: the layers that have come, the choice among them, exposure and the like, and zoom. It asks the
// display to draw at most once for each frame of the browser, and acknowledges what has been drawn.

{
  const idLayers = new Set(["object", "material"]);
  const plainColours = new Set(["albedo", "cryptomatte"]);
  const errorLayers = new Set(["flip", "variance", "error"]);

  /// How a layer is shown: radiance (exposure and tone map), colour (as it is), vector, scalar or number.
  const kindOf = (name, channels) => {
    if (idLayers.has(name)) return "number";
    if (channels.length === 1) return "scalar";
    if (plainColours.has(name)) return "colour";
    if (/(^|\.)[RY]$/.test(channels[0])) return name === "flip" ? "colour" : "radiance";
    return "vector";
  };

  /// Low and high values of a layer that leave out one in 200 on both sides. Zeros of depths are where nothing was hit.
  const measuredRange = (image) => {
    const { layer } = image.header;
    if (/normal$/.test(layer)) return [-1, 1];
    const stride = Math.max(1, Math.floor(image.data.length / 20000)),
      values = [];
    const skipsZero = ["depth", "distance", "position"].includes(layer);
    for (let i = 0; i < image.data.length; i += stride) {
      const value = image.isFloat ? image.data[i] : alhazen.halfValue(image.data[i]);
      if (Number.isFinite(value) && !(skipsZero && value === 0)) values.push(value);
    }
    if (values.length === 0) return [0, 1];
    values.sort((a, b) => a - b);
    const low = values[Math.floor(0.005 * values.length)],
      high = values[Math.ceil(0.995 * values.length) - 1];
    return high > low ? [low, high] : [Math.min(low, 0), Math.max(high, low + 1)];
  };

  /// Emits: changed (any setting), drawn (the images of a picture that were shown for the first time).
  alhazen.Picture = class extends alhazen.Events {
    images = new Map();
    settings = {
      layer: "color",
      other: null,
      split: 0.5,
      exposure: 0,
      toneMap: "none",
      channel: "rgb",
      falseColour: false,
      markUnusual: true,
      markClipped: false,
    };
    ranges = new Map(); // from layers to [low, high] that the user chose
    maps = new Map(); // from layers to colour maps that the user chose
    #measured = new Map();
    #fresh = [];

    constructor(display, viewport) {
      super();
      this.display = display;
      this.viewport = viewport;
      this.redraw = alhazen.oncePerFrame(() => this.draw());
    }

    set(settings) {
      Object.assign(this.settings, settings);
      this.emit("changed", settings);
      this.redraw();
    }

    receive(image) {
      this.images.set(image.header.layer, image);
      this.#measured.delete(image.header.layer);
      this.#fresh.push(image);
      // A page that is hidden has no animation frames, and what it acknowledges may be waited for.
      if (document.hidden) this.draw();
      else this.redraw();
    }

    /// Whether all that has come is on the display.
    get isDrawn() {
      return this.#fresh.length === 0;
    }

    /// The image that the choice of a layer shows: a denoised one that is older than the picture gives way to it.
    imageOf(name) {
      const colour = this.images.get("color");
      const image = this.images.get(name);
      if (!image) return name === this.settings.layer ? (colour ?? this.images.values().next().value) : null;
      if (name === "denoised" && colour && colour.header.view > image.header.view) return colour;
      return image;
    }

    get image() {
      return this.imageOf(this.settings.layer) ?? null;
    }

    get otherImage() {
      return this.settings.other ? this.imageOf(this.settings.other) : null;
    }

    rangeOf(image) {
      const { layer } = image.header;
      if (this.showsStops(image)) return this.ranges.get("stops") ?? [-8, 8];
      if (this.ranges.has(layer)) return this.ranges.get(layer);
      if (!this.#measured.has(layer)) this.#measured.set(layer, measuredRange(image));
      return this.#measured.get(layer);
    }

    showsStops(image) {
      return this.settings.falseColour && kindOf(image.header.layer, image.channels) === "radiance";
    }

    mapOf(image) {
      const { layer } = image.header;
      return this.maps.get(layer) ?? (errorLayers.has(layer) ? "magma" : "viridis");
    }

    kindOf(image) {
      return kindOf(image.header.layer, image.channels);
    }

    #layer(image) {
      if (!image) return null;
      const kind = this.kindOf(image);
      const needsRange = kind === "scalar" || kind === "vector" || this.showsStops(image);
      return { image, kind, range: needsRange ? this.rangeOf(image) : [0, 1], map: this.mapOf(image) };
    }

    /// What a display draws.
    view() {
      const ratio = this.viewport.pixelRatio;
      return {
        ...this.settings,
        a: this.#layer(this.image),
        b: this.#layer(this.otherImage),
        scale: this.viewport.scale * ratio,
        offset: this.viewport.offset.map((value) => value * ratio),
        smooth: this.viewport.isSmooth,
        split: this.settings.split * this.display.canvas.width,
      };
    }

    draw() {
      const image = this.image;
      if (image) this.viewport.setPictureSize(image.header.full_width, image.header.full_height);
      this.display.draw(this.view());
      const fresh = this.#fresh;
      this.#fresh = [];
      this.emit("drawn", fresh);
    }

    /// The exposure with which the mean of the logarithm of luminance is middle grey.
    suitableExposure() {
      const image = this.images.get("color") ?? this.image;
      if (!image || image.channels.length < 3) return 0;
      let sum = 0,
        count = 0;
      const stride = Math.max(1, Math.floor((image.width * image.height) / 20000));
      for (let i = 0; i < image.width * image.height; i += stride) {
        const l = alhazen.colour.luminance(image.values(i % image.width, Math.floor(i / image.width)));
        if (l > 1e-6 && Number.isFinite(l)) ((sum += Math.log2(l)), ++count);
      }
      return count ? Math.round(10 * (Math.log2(0.18) - sum / count)) / 10 : 0;
    }

    /// The chosen layer as it is shown, at full resolution, as a PNG.
    async png() {
      const image = this.image;
      if (!image) return null;
      const { full_width: width, full_height: height } = image.header;
      const canvas = alhazen.element("canvas", { width, height });
      const display = new this.display.constructor(canvas);
      display.draw({
        ...this.view(),
        b: null,
        scale: 1,
        offset: [0, 0],
        smooth: false,
        markUnusual: false,
        markClipped: false,
      });
      const blob = await new Promise((resolve) => canvas.toBlob(resolve, "image/png"));
      display.release();
      return blob;
    }
  };
}
