// What is drawn over the picture: the grid of pixels and their values when zoomed in far, and a mark where was clicked.

{
  const gridFrom = 12, valuesFrom = 68;  // CSS pixels for each pixel of the picture

  const shortValue = (value) => {
    if (Number.isNaN(value)) return "NaN";
    if (!Number.isFinite(value)) return value > 0 ? "inf" : "−inf";
    const size = Math.abs(value);
    if (value === 0) return "0";
    if (size >= 1e5 || size < 1e-4) return value.toExponential(1);
    return value.toFixed(size >= 1000 ? 0 : size >= 100 ? 1 : size >= 10 ? 2 : size >= 1 ? 3 : 4);
  };

  alhazen.Overlay = class {
    mark = null;  // a point of the picture, and when it was set
    #context;

    constructor(canvas, picture, viewport) {
      this.canvas = canvas;
      this.picture = picture;
      this.viewport = viewport;
      this.#context = canvas.getContext("2d");
    }

    /// Marks a point for a moment.
    setMark(x, y) {
      this.mark = { x, y };
      clearTimeout(this.timer);
      this.timer = setTimeout(() => {
        this.mark = null;
        this.draw();
      }, 1200);
      this.draw();
    }

    draw() {
      const context = this.#context, { pixelRatio, width, height, scale } = this.viewport;
      const [w, h] = [Math.round(width * pixelRatio), Math.round(height * pixelRatio)];
      if (this.canvas.width !== w || this.canvas.height !== h) [this.canvas.width, this.canvas.height] = [w, h];
      context.setTransform(1, 0, 0, 1, 0, 0);
      context.clearRect(0, 0, w, h);
      context.setTransform(pixelRatio, 0, 0, pixelRatio, 0, 0);
      const image = this.picture.image;
      if (image && scale * image.step >= gridFrom) this.#drawGrid(image);
      if (this.mark) this.#drawMark();
    }

    #drawGrid(image) {
      const context = this.#context, { viewport } = this, { header } = image;
      const first = viewport.toPicture([0, 0]), last = viewport.toPicture([viewport.width, viewport.height]);
      const place = (value, corner) => Math.floor((value - corner) / image.step);
      const x0 = Math.max(0, place(first[0], header.x)), x1 = Math.min(image.width, place(last[0], header.x) + 1);
      const y0 = Math.max(0, place(first[1], header.y)), y1 = Math.min(image.height, place(last[1], header.y) + 1);
      const size = viewport.scale * image.step;
      const at = (x, y) => viewport.fromPicture([header.x + x * image.step, header.y + y * image.step]);
      context.globalAlpha = alhazen.clamp((size - gridFrom) / gridFrom, 0, 1) * 0.16;
      context.strokeStyle = "#fff";
      context.lineWidth = 1 / viewport.pixelRatio;
      context.beginPath();
      for (let x = x0; x <= x1; ++x) context.moveTo(at(x, y0)[0], at(x, y0)[1]), context.lineTo(at(x, y1)[0], at(x, y1)[1]);
      for (let y = y0; y <= y1; ++y) context.moveTo(at(x0, y)[0], at(x0, y)[1]), context.lineTo(at(x1, y)[0], at(x1, y)[1]);
      context.stroke();
      context.globalAlpha = 1;
      if (size < valuesFrom) return;
      for (let y = y0; y < y1; ++y) for (let x = x0; x < x1; ++x) this.#drawValues(image, x, y, at(x, y), size);
    }

    #drawValues(image, x, y, [left, top], size) {
      const context = this.#context, values = image.values(x, y).slice(0, 4);
      const text = Math.min(14, size / 6.2), line = 1.3 * text;
      const colours = values.length >= 3 ? ["#ff9a92", "#8fdc98", "#9cc0ff", "#e2e3e5"] : ["#f2f2f2", "#f2f2f2"];
      context.font = `500 ${text}px ui-monospace, "SF Mono", "DejaVu Sans Mono", Menlo, Consolas, monospace`;
      context.textAlign = "center";
      context.textBaseline = "middle";
      // A plate behind the text: values are read on white pixels as well as on black ones.
      const height = values.length * line + 0.5 * text;
      context.fillStyle = "rgb(16 17 18 / 0.62)";
      context.beginPath();
      context.roundRect(left + size / 2 - 2.35 * text, top + (size - height) / 2, 4.7 * text, height, 0.3 * text);
      context.fill();
      values.forEach((value, i) => {
        const down = top + size / 2 + (i - (values.length - 1) / 2) * line;
        context.fillStyle = colours[i];
        context.fillText(shortValue(value), left + size / 2, down);
      });
    }

    #drawMark() {
      const context = this.#context, [x, y] = this.viewport.fromPicture([this.mark.x + 0.5, this.mark.y + 0.5]);
      for (const [width, style] of [[3.5, "rgb(0 0 0 / 0.6)"], [1.5, "#e8b04b"]]) {
        context.lineWidth = width;
        context.strokeStyle = style;
        context.beginPath();
        context.arc(x, y, 9, 0, 2 * Math.PI);
        for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
          context.moveTo(x + 5 * dx, y + 5 * dy);
          context.lineTo(x + 13 * dx, y + 13 * dy);
        }
        context.stroke();
      }
    }
  };

  alhazen.shortValue = shortValue;
}
