#!/usr/bin/env python3
"""Writes scenes/weekend.pbrt: small random spheres on a large one under a bright sky, in the manner of the cover of
"Ray Tracing in One Weekend" (Shirley), with random numbers of its own. Always the same file.

    python3 scenes/generate_weekend.py > scenes/weekend.pbrt
"""

import colorsys
import math
import random

HEADER = """\
# About 480 random spheres and three large ones under a constant sky, in the manner of the cover of "Ray Tracing in One
# Weekend" (P. Shirley). Written by scenes/generate_weekend.py.

Integrator "path" "integer maxdepth" 10
Sampler "zsobol" "integer pixelsamples" 256
PixelFilter "gaussian"
Film "rgb" "integer xresolution" 1200 "integer yresolution" 675 "string filename" "weekend.exr"
Scale -1 1 1
LookAt 13 2 3  0 0.2 0  0 1 0
Camera "perspective" "float fov" 20 "float lensradius" 0.05 "float focaldistance" 10

WorldBegin
LightSource "infinite" "rgb L" [ 0.72 0.84 1 ]

AttributeBegin
  Translate 0 -1000 0
  Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
  Shape "sphere" "float radius" 1000
AttributeEnd
"""

LARGE = [
    ((0, 1, 0), 1, 'Material "dielectric" "float eta" 1.5'),
    ((-4, 1, 0), 1, 'Material "diffuse" "rgb reflectance" [ 0.4 0.2 0.1 ]'),
    ((4, 1, 0), 1, 'Material "conductor" "rgb reflectance" [ 0.7 0.6 0.5 ]'),
]


def text(*values):
    return " ".join(f"{value:.4g}" for value in values)


def small_material(rng):
    kind = rng.random()
    if kind < 0.8:
        colour = colorsys.hsv_to_rgb(rng.random(), rng.uniform(0.3, 0.9), rng.uniform(0.3, 0.95))
        return f'Material "diffuse" "rgb reflectance" [ {text(*(c ** 2.2 for c in colour))} ]'
    if kind < 0.95:
        colour = (rng.uniform(0.5, 1) for _ in range(3))
        return (f'Material "conductor" "rgb reflectance" [ {text(*colour)} ] '
                f'"float roughness" {text(rng.uniform(0, 0.25))}')
    return 'Material "dielectric" "float eta" 1.5'


def on_ground(x, z, radius):
    """The height at which a sphere touches the ground sphere, which falls away from its top."""
    return math.sqrt((1000 + radius) ** 2 - x * x - z * z) - 1000


def sphere(centre, radius, material):
    return (f'AttributeBegin Translate {text(*centre)} {material} '
            f'Shape "sphere" "float radius" {text(radius)} AttributeEnd')


def main():
    rng = random.Random(1965)
    lines = [HEADER]
    radius = 0.2
    for i in range(-11, 11):
        for k in range(-11, 11):
            x, z = i + 0.05 + 0.85 * rng.random(), k + 0.05 + 0.85 * rng.random()
            material = small_material(rng)
            centre = (x, on_ground(x, z, radius), z)
            if all(math.dist(centre, other) > radius + size for other, size, _ in LARGE):
                lines.append(sphere(centre, radius, material))
    lines += [sphere(*large) for large in LARGE]
    print("\n".join(lines))


if __name__ == "__main__":
    main()
