// Shows layers by WebGL2. Half-floats and floats are textures of the same type, so nothing is rounded.

{
  const kinds = { radiance: 0, vector: 1, scalar: 2, number: 3, colour: 4 };
  const maps = { viridis: 0, magma: 1, grey: 2 };
  const channels = ["rgb", "r", "g", "b", "a", "luminance"];

  const build = (gl) => {
    const program = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, alhazen.shader.vertex], [gl.FRAGMENT_SHADER, alhazen.shader.fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
        throw new Error(gl.getShaderInfoLog(shader));
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost())
      throw new Error(gl.getProgramInfoLog(program));
    return program;
  };

  alhazen.WebGLDisplay = class {
    #gl;
    #program;
    #uniforms = new Map();
    #textures = new Map();  // from layers to { texture, image }

    /// Throws if there is no WebGL2. `onRestored` is called when a lost context is there again and must be drawn anew.
    constructor(canvas, onRestored = () => {}) {
      const options = { alpha: true, antialias: false, depth: false, preserveDrawingBuffer: true };
      this.#gl = canvas.getContext("webgl2", options);
      if (!this.#gl) throw new Error("this browser has no WebGL2");
      this.name = "WebGL2";
      this.canvas = canvas;
      this.#program = build(this.#gl);
      canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
      canvas.addEventListener("webglcontextrestored", () => {
        this.#program = build(this.#gl);
        this.#uniforms.clear();
        this.#textures.clear();
        onRestored();
      });
    }

    get largestSize() {
      return this.#gl.getParameter(this.#gl.MAX_TEXTURE_SIZE);
    }

    release() {
      this.#gl.getExtension("WEBGL_lose_context")?.loseContext();
    }

    #uniform(name) {
      if (!this.#uniforms.has(name)) this.#uniforms.set(name, this.#gl.getUniformLocation(this.#program, name));
      return this.#uniforms.get(name);
    }

    /// The texture of an image, which is uploaded if it is not the one that its layer showed before.
    #textureOf(image) {
      const gl = this.#gl, layer = image.header.layer;
      const known = this.#textures.get(layer);
      if (known?.image === image) return known.texture;
      const texture = known?.texture ?? gl.createTexture();
      const count = Math.min(image.channels.length, 4), format = [gl.RED, gl.RG, gl.RGB, gl.RGBA][count - 1];
      const stored = image.isFloat ? [gl.R32F, gl.RG32F, gl.RGB32F, gl.RGBA32F] : [gl.R16F, gl.RG16F, gl.RGB16F, gl.RGBA16F];
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
      for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.NEAREST);
      for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
      gl.texImage2D(gl.TEXTURE_2D, 0, stored[count - 1], image.width, image.height, 0, format,
        image.isFloat ? gl.FLOAT : gl.HALF_FLOAT, firstChannels(image, count));
      this.#textures.set(layer, { texture, image });
      return texture;
    }

    #setLayer(name, unit, shown) {
      const gl = this.#gl, { image, kind, range, map } = shown;
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, this.#textureOf(image));
      gl.uniform1i(this.#uniform(`image_${name}`), unit);
      const set = (member) => this.#uniform(`layer_${name}.${member}`);
      gl.uniform2i(set("size"), image.width, image.height);
      gl.uniform2f(set("corner"), image.header.x, image.header.y);
      gl.uniform1f(set("step"), image.step);
      gl.uniform1i(set("channels"), image.channels.length);
      gl.uniform1i(set("kind"), kinds[kind]);
      gl.uniform2f(set("range"), range[0], range[1]);
      gl.uniform1i(set("map"), maps[map]);
    }

    /// `view`: what all displays are given (35-picture.js).
    draw(view) {
      const gl = this.#gl;
      if (gl.isContextLost()) return;
      gl.viewport(0, 0, this.canvas.width, this.canvas.height);
      gl.clearColor(0, 0, 0, 0);
      gl.clear(gl.COLOR_BUFFER_BIT);
      if (!view.a) return;
      gl.useProgram(this.#program);
      this.#setLayer("a", 0, view.a);
      this.#setLayer("b", 1, view.b ?? view.a);
      gl.uniform2f(this.#uniform("canvas"), this.canvas.width, this.canvas.height);
      gl.uniform2f(this.#uniform("offset"), view.offset[0], view.offset[1]);
      gl.uniform2f(this.#uniform("full_size"), view.a.image.header.full_width, view.a.image.header.full_height);
      gl.uniform1f(this.#uniform("scale"), view.scale);
      gl.uniform1f(this.#uniform("split"), view.b ? view.split : 1e9);
      gl.uniform1i(this.#uniform("smooth_full"), view.smooth ? 1 : 0);
      gl.uniform1i(this.#uniform("mark_unusual"), view.markUnusual ? 1 : 0);
      gl.uniform1i(this.#uniform("mark_clipped"), view.markClipped ? 1 : 0);
      gl.uniform1i(this.#uniform("channel"), channels.indexOf(view.channel));
      gl.uniform1i(this.#uniform("tone_map_kind"), alhazen.colour.toneMaps.indexOf(view.toneMap));
      gl.uniform1f(this.#uniform("exposure"), view.exposure);
      gl.uniform1i(this.#uniform("stops"), view.falseColour ? 1 : 0);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }
  };

  const firstChannels = (image, count) => {
    const all = image.channels.length;
    if (all === count) return image.data;
    const some = new image.data.constructor(image.width * image.height * count);
    for (let i = 0; i < image.width * image.height; ++i)
      for (let c = 0; c < count; ++c) some[i * count + c] = image.data[i * all + c];
    return some;
  };
}
