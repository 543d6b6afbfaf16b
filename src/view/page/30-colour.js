// From linear values to bytes of a display, with the same formulas as `alhazen render` (src/images/display/), in double
// precision: for the values under the pointer, for displays without WebGL2, and to name what the shader computes as well.

{
  const toneMaps = ["none", "reinhard", "filmic", "aces", "agx"];
  const luminance = ([r, g, b]) => 0.2126390058715103 * r + 0.7151686787677559 * g + 0.0721923153607337 * b;
  const clamp01 = (value) => Math.min(Math.max(value, 0), 1);
  const multiply = (rows, v) => rows.map((row) => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);

  const srgbEncode = (linear) => (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055);
  const srgbDecode = (encoded) => (encoded <= 0.04045 ? encoded / 12.92 : ((encoded + 0.055) / 1.055) ** 2.4);

  /// Narkowicz 2015 (tone_map.cpp).
  const filmic = (x) => (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);

  /// Hill 2016 (tone_map.cpp).
  const aces = (colour) => {
    const curve = (x) => (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.432951) + 0.238081);
    const within = multiply(
      [[0.59719, 0.35458, 0.04823], [0.076, 0.90834, 0.01566], [0.0284, 0.13383, 0.83777]], colour);
    return multiply(
      [[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]],
      within.map(curve));
  };

  /// The sigmoid of AgX (agx.cpp): each half is y = 2 x / (1 + (2 x / c)^p)^(1 / p), measured from the pivot.
  const agxPivot = 10 / 16.5;
  const halfScale = (end, p) => ((2 * end) ** -p * ((4 * end) ** p - 1)) ** (-1 / p);
  const agxScales = { toe: halfScale(agxPivot, 3), shoulder: halfScale(1 - agxPivot, 3.25) };
  const agxHalf = (x, scale, p) => (2 * x) / (1 + (2 * x / scale) ** p) ** (1 / p);

  const agxEncode = (linear) => {
    if (!(linear > 0)) return 0;
    const x = clamp01((Math.log2(linear) - Math.log2(0.18) + 10) / 16.5);
    return clamp01(x < agxPivot ? 0.5 - agxHalf(agxPivot - x, agxScales.toe, 3)
      : 0.5 + agxHalf(x - agxPivot, agxScales.shoulder, 3.25));
  };

  const inverse = (m) => {
    const [a, b, c] = m, { cross, dot, scale } = alhazen.vec;
    const columns = [cross(b, c), cross(c, a), cross(a, b)].map((column) => scale(column, 1 / dot(a, cross(b, c))));
    return [0, 1, 2].map((row) => columns.map((column) => column[row]));
  };

  const agxInset = [[0.842479062253094, 0.0784335999999992, 0.0792237451477643],
    [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
    [0.0423756549057051, 0.0784336, 0.879142973793104]];
  const agxOutset = inverse(agxInset);

  const agx = (colour) => multiply(agxOutset, multiply(agxInset, colour).map(agxEncode)).map((x) => clamp01(x) ** 2.2);

  /// Linear values from 0 to 1 for a display. NaN and negative values become 0.
  const toneMap = (colour, kind) => {
    const bounded = colour.map((value) => (value > 0 ? Math.min(value, 1e30) : 0));
    const mapped = {
      none: () => bounded,
      reinhard: () => bounded.map((value) => value / (1 + luminance(bounded))),
      filmic: () => bounded.map(filmic),
      aces: () => aces(bounded),
      agx: () => agx(bounded),
    }[kind]();
    return mapped.map(clamp01);
  };

  const displayBytes = (colour, exposure, kind) =>
    toneMap(colour.map((value) => value * 2 ** exposure), kind).map((value) => Math.floor(255 * srgbEncode(value) + 0.5));

  /// Samples of two colour maps by Smith and van der Walt (2015, in the public domain), sRGB with 8 bits, equidistant:
  /// viridis for measurements, magma for errors (colour_map.cpp).
  const colourMaps = {
    viridis: [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99],
      [170, 220, 50], [253, 231, 37]],
    magma: [[0, 0, 4], [28, 16, 68], [79, 18, 123], [129, 37, 129], [181, 54, 122], [229, 80, 100], [251, 135, 97],
      [254, 194, 135], [252, 253, 191]],
  };

  /// sRGB from 0 to 1, encoded.
  const mapColour = (name, value) => {
    const knots = colourMaps[name], place = clamp01(value) * (knots.length - 1);
    const i = Math.min(Math.floor(place), knots.length - 2), t = place - i;
    return [0, 1, 2].map((c) => (knots[i][c] * (1 - t) + knots[i + 1][c] * t) / 255);
  };

  alhazen.colour = {
    toneMaps, toneMap, displayBytes, srgbEncode, srgbDecode, luminance, colourMaps, mapColour, agxScales, agxInset,
    agxOutset,
  };
}
