// Decodes binary frames into images. A frame is "ALHF", the length of a JSON header, the header, and a payload compressed
// by raw deflate: for each tile and channel, the bytes of all its pixels, the least significant ones first.

{
  const littleEndian = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;

  /// The value of the 16 bits of a half-float.
  const halfValue = (bits) => {
    const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, fraction = bits & 1023;
    if (exponent === 0) return sign * fraction * 2 ** -24;
    if (exponent === 31) return fraction ? NaN : sign * Infinity;
    return sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
  };

  /// A layer of the picture: `data` holds the channels of each pixel together, rows from the top down, as 16 bits of
  /// half-floats or as floats.
  class LayerImage {
    constructor(header, data) {
      this.header = header;
      this.channels = header.channels;
      this.width = header.width;
      this.height = header.height;
      this.step = header.step;
      this.isFloat = header.type === "float";
      this.data = data;
    }

    /// A channel of a pixel that was rendered.
    value(x, y, channel) {
      const stored = this.data[(y * this.width + x) * this.channels.length + channel];
      return this.isFloat ? stored : halfValue(stored);
    }

    values(x, y) {
      return this.channels.map((_, channel) => this.value(x, y, channel));
    }

    /// The pixel that shows a place of the whole picture at full resolution, or null.
    pixelAt(fullX, fullY) {
      const x = Math.floor((fullX - this.header.x) / this.step), y = Math.floor((fullY - this.header.y) / this.step);
      return x >= 0 && y >= 0 && x < this.width && y < this.height ? [x, y] : null;
    }

    /// All values as floats, for statistics.
    floats() {
      if (this.isFloat) return this.data;
      const values = new Float32Array(this.data.length);
      for (let i = 0; i < values.length; ++i) values[i] = halfValue(this.data[i]);
      return values;
    }
  }

  const parseHeader = (buffer) => {
    const view = new DataView(buffer);
    if (buffer.byteLength < 8 || view.getUint32(0, false) !== 0x414c4846) throw new Error("not a frame");
    const length = view.getUint32(4, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, length)));
    header.payload = new Uint8Array(buffer, 8 + length);
    return header;
  };

  /// At most `bytes` of what the deflated bytes hold.
  const inflate = async (deflated, bytes) => {
    const stream = new Blob([deflated]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    const reader = stream.getReader(), inflated = new Uint8Array(bytes);
    let count = 0;
    for (;;) {
      const { done, value } = await reader.read();
      if (done) break;
      if (count + value.length > bytes) throw new Error("a frame is longer than its header says");
      inflated.set(value, count);
      count += value.length;
    }
    if (count !== bytes) throw new Error("a frame is shorter than its header says");
    return inflated;
  };

  /// Puts the byte planes of one channel of a tile to their places. `words` are the pixels' values as integers.
  const placeChannel = (bytes, offset, pixels, words, wordBytes, tile, width, channels, channel) => {
    for (let y = 0, i = offset; y < tile.height; ++y) {
      let out = ((tile.y + y) * width + tile.x) * channels + channel;
      for (let x = 0; x < tile.width; ++x, ++i, out += channels) {
        words[out] = wordBytes === 2
          ? bytes[i] | (bytes[i + pixels] << 8)
          : bytes[i] | (bytes[i + pixels] << 8) | (bytes[i + 2 * pixels] << 16) | (bytes[i + 3 * pixels] << 24);
      }
    }
  };

  const tilesOf = (header) => {
    const across = Math.ceil(header.width / header.tile), down = Math.ceil(header.height / header.tile);
    const indices = header.tiles ?? Array.from({ length: across * down }, (_, i) => i);
    return indices.map((index) => {
      const x = (index % across) * header.tile, y = Math.floor(index / across) * header.tile;
      if (!(index >= 0) || y >= header.height) throw new Error("a frame has a tile outside of it");
      return { x, y, width: Math.min(header.tile, header.width - x), height: Math.min(header.tile, header.height - y) };
    });
  };

  /// Emits: image (a LayerImage; its header says which), skipped (the header of a frame that a later one made useless),
  /// broken (the header of one that cannot be decoded).
  alhazen.FrameDecoder = class extends alhazen.Events {
    #queue = [];
    #busy = false;
    #images = new Map();

    /// Forgets what earlier frames held: a new connection begins with whole ones.
    reset() {
      this.#queue = [];
      this.#images.clear();
    }

    receive(buffer) {
      const header = parseHeader(buffer);
      // A whole frame replaces all that wait of its layer. One of some tiles needs those before it.
      if (header.tiles === null || header.tiles === undefined) {
        const [late, kept] = [[], []];
        for (const queued of this.#queue) (queued.layer === header.layer ? late : kept).push(queued);
        this.#queue = kept;
        for (const queued of late) this.emit("skipped", queued);
      }
      this.#queue.push(header);
      if (!this.#busy) this.#work();
    }

    async #work() {
      this.#busy = true;
      while (this.#queue.length > 0) {
        const header = this.#queue.shift();
        try {
          const image = await this.#decode(header);
          this.emit("image", image);
        } catch (error) {
          console.warn(`frame ${header.frame}:`, error.message);
          // Frames of some tiles that follow would be wrong as well, until there is a whole one.
          this.emit("broken", header);
        }
      }
      this.#busy = false;
    }

    async #decode(header) {
      const bytes = await inflate(header.payload, header.bytes);
      delete header.payload;
      const channels = header.channels.length, wordBytes = header.type === "float" ? 4 : 2;
      const data = this.#startingData(header, header.width * header.height * channels);
      const words = wordBytes === 4 ? new Uint32Array(data.buffer) : data;
      const tiles = tilesOf(header);
      const needed = tiles.reduce((sum, tile) => sum + tile.width * tile.height, 0) * channels * wordBytes;
      if (needed !== bytes.length || !littleEndian) throw new Error("its tiles do not have the bytes that it holds");
      let offset = 0;
      for (const tile of tiles) {
        const pixels = tile.width * tile.height;
        for (let channel = 0; channel < channels; ++channel, offset += wordBytes * pixels)
          placeChannel(bytes, offset, pixels, words, wordBytes, tile, header.width, channels, channel);
      }
      const image = new LayerImage(header, data);
      this.#images.set(header.layer, image);
      return image;
    }

    /// Zeros, or what the viewer's last frame of this layer, size and type held.
    #startingData(header, count) {
      const last = this.#images.get(header.layer);
      const keeps = header.tiles && last && last.width === header.width && last.height === header.height &&
        last.header.type === header.type && last.data.length === count;
      if (keeps) return last.data;
      return header.type === "float" ? new Float32Array(count) : new Uint16Array(count);
    }
  };

  alhazen.LayerImage = LayerImage;
  alhazen.halfValue = halfValue;
}
