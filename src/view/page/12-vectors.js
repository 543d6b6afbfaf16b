// Vectors of three numbers, as arrays.

{
  const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
  const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
  const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const length = (a) => Math.hypot(a[0], a[1], a[2]);

  const normalize = (a) => {
    const l = length(a);
    return l > 0 ? scale(a, 1 / l) : [0, 0, 0];
  };

  /// Rotates v about a unit axis by the right-hand rule (Rodrigues).
  const rotate = (v, axis, angle) => {
    const c = Math.cos(angle), s = Math.sin(angle);
    return add(add(scale(v, c), scale(cross(axis, v), s)), scale(axis, dot(axis, v) * (1 - c)));
  };

  alhazen.vec = { add, subtract, scale, dot, cross, length, normalize, rotate };
}
