// Where the picture is in its part of the page: fitted, or zoomed and moved. Lengths are in CSS pixels.

{
  const smallest = 1 / 32, largest = 256;

  /// Emits: changed.
  alhazen.Viewport = class extends alhazen.Events {
    width = 1;
    height = 1;
    pictureWidth = 0;
    pictureHeight = 0;
    pixelRatio = 1;
    scale = 1;
    offset = [0, 0];
    isFitted = true;

    /// Follows the size of an element.
    constructor(element) {
      super();
      this.element = element;
      const update = () => {
        const box = element.getBoundingClientRect(), centre = [this.width / 2, this.height / 2];
        this.width = Math.max(1, box.width);
        this.height = Math.max(1, box.height);
        this.pixelRatio = devicePixelRatio || 1;
        if (this.isFitted) this.#fit();
        else this.offset = [this.offset[0] + this.width / 2 - centre[0], this.offset[1] + this.height / 2 - centre[1]];
        this.emit("changed");
      };
      new ResizeObserver(update).observe(element);
      update();
    }

    /// A pixel on the display is smoothed where fitting enlarges the picture a little; who zooms in wants to see pixels.
    get isSmooth() {
      return this.isFitted && this.scale * this.pixelRatio < 3 && this.scale * this.pixelRatio !== 1;
    }

    setPictureSize(width, height) {
      if (width === this.pictureWidth && height === this.pictureHeight) return;
      // What is seen of the picture stays, at another resolution.
      const ratio = this.pictureWidth / width;
      this.pictureWidth = width;
      this.pictureHeight = height;
      if (this.isFitted || !Number.isFinite(ratio) || ratio === 0) this.#fit();
      else this.scale *= ratio;
      this.emit("changed");
    }

    #fit() {
      if (!this.pictureWidth) return;
      this.isFitted = true;
      this.scale = Math.min(this.width / this.pictureWidth, this.height / this.pictureHeight);
      this.offset = [(this.width - this.scale * this.pictureWidth) / 2, (this.height - this.scale * this.pictureHeight) / 2];
    }

    fit() {
      this.#fit();
      this.emit("changed");
    }

    /// Zooms so that the point of the picture under `at` stays there.
    zoomTo(scale, at = [this.width / 2, this.height / 2]) {
      const to = alhazen.clamp(scale, smallest, largest), factor = to / this.scale;
      this.offset = this.offset.map((value, i) => at[i] - (at[i] - value) * factor);
      this.scale = to;
      this.isFitted = false;
      this.#snap();
      this.emit("changed");
    }

    /// One pixel of the picture on one of the display.
    oneToOne(at) {
      this.zoomTo(1 / this.pixelRatio, at);
    }

    pan(dx, dy) {
      this.offset = [this.offset[0] + dx, this.offset[1] + dy];
      this.isFitted = false;
      // A part of the picture always stays in view.
      const margin = 40, sizes = [this.pictureWidth * this.scale, this.pictureHeight * this.scale];
      this.offset = this.offset.map((value, i) =>
        alhazen.clamp(value, margin - sizes[i], [this.width, this.height][i] - margin));
      this.#snap();
      this.emit("changed");
    }

    /// Pixels of the picture begin at pixels of the display where that makes them sharp.
    #snap() {
      if (this.scale * this.pixelRatio >= 1)
        this.offset = this.offset.map((value) => Math.round(value * this.pixelRatio) / this.pixelRatio);
    }

    /// The point of the picture at a point of the element.
    toPicture([x, y]) {
      return [(x - this.offset[0]) / this.scale, (y - this.offset[1]) / this.scale];
    }

    fromPicture([x, y]) {
      return [x * this.scale + this.offset[0], y * this.scale + this.offset[1]];
    }

    contains([x, y]) {
      const [px, py] = this.toPicture([x, y]);
      return px >= 0 && py >= 0 && px < this.pictureWidth && py < this.pictureHeight;
    }
  };
}
