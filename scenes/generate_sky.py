#!/usr/bin/env python3
"""Writes scenes/sky.hdr, an equirectangular environment map (Radiance RGBE) of 256 x 128 pixels: a clear sky with a low
sun, haze along the horizon, and a ground. Always the same file.

    python3 scenes/generate_sky.py > scenes/sky.hdr

The top is up, as `alhazen render --environment` takes it; the sun is to the left of the middle.
"""

import math
import struct
import sys

WIDTH, HEIGHT = 256, 128
SUN_AZIMUTH, SUN_ELEVATION = math.radians(-62), math.radians(34)  # azimuth from the middle of the map to the right
SUN_RADIUS = math.radians(1.4)  # about a texel, several times that of the real sun: shadows are softer
SUN = (3000.0, 2450.0, 1750.0)
ZENITH, HORIZON, GROUND = (0.04, 0.12, 0.36), (0.3, 0.37, 0.46), (0.08, 0.07, 0.055)
GLOW = (0.5, 0.39, 0.25)
SUBSAMPLES = 4  # in each direction of a texel


def direction(azimuth, elevation):
    return (math.cos(elevation) * math.sin(azimuth), math.sin(elevation), -math.cos(elevation) * math.cos(azimuth))


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def radiance(d):
    """Radiance from the unit direction d, y up."""
    cosine = sum(a * b for a, b in zip(d, direction(SUN_AZIMUTH, SUN_ELEVATION)))
    angle = math.acos(max(-1, min(1, cosine)))
    haze = 1.1 * math.exp(-angle / 0.25)
    if d[1] < 0:  # the ground fades into the haze where it is far away
        return mix(GROUND, HORIZON, math.exp(d[1] * 12))
    colour = mix(HORIZON, ZENITH, 1 - math.exp(-3.2 * d[1]))
    return tuple(c + haze * g + (s if angle < SUN_RADIUS else 0) for c, g, s in zip(colour, GLOW, SUN))


def texel(row, column):
    total = (0.0, 0.0, 0.0)
    for j in range(SUBSAMPLES):
        for i in range(SUBSAMPLES):
            azimuth = (2 * (column + (i + 0.5) / SUBSAMPLES) / WIDTH - 1) * math.pi
            elevation = (0.5 - (row + (j + 0.5) / SUBSAMPLES) / HEIGHT) * math.pi
            total = tuple(t + c for t, c in zip(total, radiance(direction(azimuth, elevation))))
    return tuple(t / SUBSAMPLES ** 2 for t in total)


def rgbe(colour):
    """Three mantissas and the exponent that they share."""
    exponent = math.frexp(max(colour))[1]
    return [min(255, int(c * 2.0 ** (8 - exponent))) for c in colour] + [exponent + 128]


def encode_run_lengths(values):
    """A component of a row, as runs (128 + length, value) and stretches (length, values)."""
    out, i = bytearray(), 0
    while i < len(values):
        run = next((k for k in range(1, min(127, len(values) - i)) if values[i + k] != values[i]),
                   min(127, len(values) - i))
        if run >= 3:
            out += bytes((128 + run, values[i]))
            i += run
            continue
        start = i
        while i < len(values) and i - start < 128 and len(set(values[i:i + 3])) > 1:
            i += 1
        i = max(i, start + 1)
        out += bytes((i - start, *values[start:i]))
    return out


def main():
    out = bytearray(b"#?RADIANCE\n# Written by scenes/generate_sky.py\nFORMAT=32-bit_rle_rgbe\n\n")
    out += b"-Y %d +X %d\n" % (HEIGHT, WIDTH)
    for row in range(HEIGHT):
        pixels = [rgbe(texel(row, column)) for column in range(WIDTH)]
        out += struct.pack(">BBH", 2, 2, WIDTH)
        for component in zip(*pixels):
            out += encode_run_lengths(component)
    sys.stdout.buffer.write(out)


if __name__ == "__main__":
    main()
