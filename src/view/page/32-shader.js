// The shader that shows a layer. All of the display happens here: exposure, tone map, false colour, channels, marks of
// values that are not finite, and zooming. The formulas are those of 30-colour.js, from which the numbers are taken.

{
  const number = (value) => (Number.isInteger(value) ? `${value}.0` : String(value));
  const rows = (m) => `mat3(${m.flat().map(number).join(", ")})`;  // used from the left: vector * matrix
  const { agxScales, agxInset, agxOutset, colourMaps } = alhazen.colour;
  const knots = (name) => colourMaps[name].map((c) => `vec3(${c.map((x) => number(x / 255)).join(", ")})`).join(", ");

  const vertex = `#version 300 es
  void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
  }`;

  const colours = `
  const float largest = 1e30;
  float luminance(vec3 c) { return dot(c, vec3(0.21263901, 0.71516868, 0.07219232)); }

  vec3 srgb_encode(vec3 c) {
    return mix(1.055 * pow(max(c, 1e-9), vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
  }

  vec3 aces(vec3 c) {
    vec3 x = c * ${rows([[0.59719, 0.35458, 0.04823], [0.076, 0.90834, 0.01566], [0.0284, 0.13383, 0.83777]])};
    x = min(x, 1e15);
    x = (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.432951) + 0.238081);
    return x * ${rows([[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]])};
  }

  float agx_encode(float linear) {
    if (!(linear > 0.0)) return 0.0;
    const float pivot = ${number(10 / 16.5)};
    float x = clamp((log2(linear) - log2(0.18) + 10.0) / 16.5, 0.0, 1.0);
    bool below = x < pivot;
    float d = 2.0 * abs(x - pivot), p = below ? 3.0 : 3.25;
    if (d <= 0.0) return 0.5;
    float y = d / pow(1.0 + pow(d / (below ? ${number(agxScales.toe)} : ${number(agxScales.shoulder)}), p), 1.0 / p);
    return clamp(below ? 0.5 - y : 0.5 + y, 0.0, 1.0);
  }

  vec3 agx(vec3 c) {
    vec3 inside = c * ${rows(agxInset)};
    vec3 encoded = vec3(agx_encode(inside.x), agx_encode(inside.y), agx_encode(inside.z)) * ${rows(agxOutset)};
    return pow(clamp(encoded, 0.0, 1.0), vec3(2.2));
  }

  vec3 tone_map(vec3 colour, int kind) {
    vec3 c = vec3(colour.r > 0.0 ? min(colour.r, largest) : 0.0, colour.g > 0.0 ? min(colour.g, largest) : 0.0,
                  colour.b > 0.0 ? min(colour.b, largest) : 0.0);
    if (kind == 1) c = c / (1.0 + luminance(c));
    else if (kind == 2) { c = min(c, 1e15); c = c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14); }
    else if (kind == 3) c = aces(c);
    else if (kind == 4) c = agx(c);
    return clamp(c, 0.0, 1.0);
  }

  vec3 colour_map(int map, float value) {
    const vec3 viridis[9] = vec3[9](${knots("viridis")});
    const vec3 magma[9] = vec3[9](${knots("magma")});
    float place = clamp(value, 0.0, 1.0) * 8.0;
    int i = min(int(place), 7);
    vec3 low = map == 1 ? magma[i] : viridis[i], high = map == 1 ? magma[i + 1] : viridis[i + 1];
    return mix(low, high, place - float(i));
  }

  // A colour of its own for each number, with hues that differ as much as they can (golden ratio).
  vec3 number_colour(float value) {
    if (value <= 0.0) return vec3(0.09);
    float hue = fract(value * 0.61803398875), shade = 0.55 + 0.4 * fract(value * 0.7548776662);
    return shade * (0.55 + 0.45 * cos(6.2831853 * (hue + vec3(0.0, 0.33, 0.67))));
  }`;

  const fragment = `#version 300 es
  precision highp float;
  precision highp int;
  precision highp sampler2D;
  out vec4 result;

  struct Layer { ivec2 size; vec2 corner; float step; int channels; int kind; vec2 range; int map; };
  uniform sampler2D image_a, image_b;
  uniform Layer layer_a, layer_b;
  uniform vec2 canvas, offset, full_size;  // device pixels; offset: of the upper left corner of the picture
  uniform float scale, split;              // device pixels for each pixel of the picture; of the line between layers
  uniform bool smooth_full, mark_unusual, mark_clipped;
  uniform int channel, tone_map_kind;
  uniform float exposure;
  uniform bool stops;
  ${colours}

  bool finite(float v) { return (floatBitsToUint(v) & 0x7f800000u) != 0x7f800000u; }
  bool is_nan(float v) { return !finite(v) && (floatBitsToUint(v) & 0x007fffffu) != 0u; }

  vec4 texel(sampler2D image, Layer layer, ivec2 p) {
    return texelFetch(image, clamp(p, ivec2(0), layer.size - 1), 0);
  }

  vec4 bilinear(sampler2D image, Layer layer, vec2 p) {
    vec2 q = p - 0.5, f = fract(q);
    ivec2 i = ivec2(floor(q));
    return mix(mix(texel(image, layer, i), texel(image, layer, i + ivec2(1, 0)), f.x),
               mix(texel(image, layer, i + ivec2(0, 1)), texel(image, layer, i + ivec2(1, 1)), f.x), f.y);
  }

  // The mean over a pixel of the display where the picture is shown smaller than it is.
  vec4 mean(sampler2D image, Layer layer, vec2 p, float footprint) {
    int taps = clamp(int(ceil(footprint)), 1, 4);
    vec4 sum = vec4(0.0);
    for (int y = 0; y < taps; ++y)
      for (int x = 0; x < taps; ++x)
        sum += texel(image, layer, ivec2(floor(p + footprint * ((vec2(x, y) + 0.5) / float(taps) - 0.5))));
    return sum / float(taps * taps);
  }

  vec4 value_at(sampler2D image, Layer layer, vec2 full) {
    vec2 p = (full - layer.corner) / layer.step;
    float texels = 1.0 / (scale * layer.step);  // in a pixel of the display
    if (layer.kind == 3) return texel(image, layer, ivec2(floor(p)));
    if (texels > 1.0) return mean(image, layer, p, texels);
    if (layer.step > 1.0 || smooth_full) return bilinear(image, layer, p);
    return texel(image, layer, ivec2(floor(p)));
  }

  vec3 shown(vec4 value, Layer layer) {
    if (layer.channels == 2) value.ba = vec2(0.0, 1.0);
    float range = max(layer.range.y - layer.range.x, 1e-30);
    if (layer.kind == 3) return number_colour(value.r);
    if (layer.kind == 2) {
      float v = (value.r - layer.range.x) / range;
      return layer.map == 2 ? vec3(clamp(v, 0.0, 1.0)) : colour_map(layer.map, v);
    }
    if (channel == 5 && layer.kind != 1) value.rgb = vec3(luminance(value.rgb));
    else if (channel > 0 && channel < 5) value.rgb = vec3(value[channel - 1]);
    if (layer.kind == 1) return clamp((value.rgb - layer.range.x) / range, 0.0, 1.0);
    if (layer.kind == 4) return srgb_encode(clamp(value.rgb, 0.0, 1.0));
    vec3 linear = value.rgb * exp2(exposure);
    if (stops) {
      float l = luminance(linear);
      return l > 0.0 ? colour_map(0, (log2(l / 0.18) - layer.range.x) / range) : vec3(0.0);
    }
    return srgb_encode(tone_map(linear, tone_map_kind));
  }

  vec3 marked(vec3 colour, vec4 value, Layer layer) {
    bool stripe = mod(gl_FragCoord.x + gl_FragCoord.y, 12.0) < 6.0;
    if (mark_unusual) {
      bool nan = false, infinite = false, negative = false;
      for (int i = 0; i < min(layer.channels, 4); ++i) {
        nan = nan || is_nan(value[i]);
        infinite = infinite || (!finite(value[i]) && !is_nan(value[i]));
        negative = negative || value[i] < 0.0;
      }
      if (nan) return stripe ? vec3(1.0, 0.0, 1.0) : vec3(0.25, 0.0, 0.25);
      if (infinite) return stripe ? vec3(1.0, 0.85, 0.0) : vec3(0.3, 0.25, 0.0);
      if (negative && layer.kind != 1) return stripe ? vec3(0.1, 0.5, 1.0) : vec3(0.0, 0.1, 0.3);
    }
    if (mark_clipped && layer.kind == 0 && !stops && any(greaterThanEqual(colour, vec3(254.5 / 255.0))))
      return stripe ? vec3(1.0, 0.2, 0.15) : colour;
    return colour;
  }

  void main() {
    vec2 at = vec2(gl_FragCoord.x, canvas.y - gl_FragCoord.y);
    vec2 full = (at - offset) / scale;
    if (any(lessThan(full, vec2(0.0))) || any(greaterThanEqual(full, full_size))) {
      result = vec4(0.0);
      return;
    }
    vec4 a, b;
    bool left = at.x < split;
    vec4 value = left ? value_at(image_a, layer_a, full) : value_at(image_b, layer_b, full);
    vec3 colour;
    if (left) colour = marked(shown(value, layer_a), value, layer_a);
    else colour = marked(shown(value, layer_b), value, layer_b);
    result = vec4(colour, 1.0);
  }`;

  alhazen.shader = { vertex, fragment };
}
