#!/usr/bin/env python3
"""Writes scenes/spheres.pbrt: the sphere scene of the report "Accelerating Ray Tracing". Always the same file.

    python3 scenes/generate_spheres.py > scenes/spheres.pbrt
"""

import colorsys
import math
import random

HEADER = """\
# The sphere scene, after Figure 2 of the report "Accelerating Ray Tracing" (Huang, Kuanyshbay, Long).
# Written by scenes/generate_spheres.py.
#
# Given by the report: objects are spheres only, among them a ground, a light, a moving sphere, a metal sphere and a
# noise sphere, with diffuse, specular and dielectric materials; the scene follows the first two books of "Ray Tracing
# in One Weekend", whose last scene has a block of 1,000 small spheres; the background is black; D = 10 segments a path,
# S = 1,000 samples a pixel; in Figure 3 the top of the picture is background, where a path has one segment on average,
# and towards the bottom it has up to 9 or 10.
# Chosen here: where everything stands, its size, colour and texture, the camera, 800 x 800 pixels. pbrt's maxdepth
# counts bounces, so D = 10 is maxdepth 9. The light is large, so that it is also found by chance (the integrators
# branching, recursive and iterative). Under an open sky paths leave the scene sooner than in Figure 3: they have 1 segment
# at the top, 2 to 3 on the ground, 3 to 5 where glass and cloud are (`alhazen render --aov bounces`).
"""

CLOUD_SPHERES = 1000
CLOUD_CENTRE = (-2.25, 1.36, -2.3)
CLOUD_SIDE = 2.5
CLOUD_TURN = 33  # degrees about the vertical axis
CLOUD_RADII = (0.075, 0.118)


def text(*values):
    return " ".join(f"{value:.4g}" if abs(value) < 1000 else f"{value:g}" for value in values)


def block(lines, body):
    lines.append("AttributeBegin")
    lines.extend("  " + line for line in body)
    lines.append("AttributeEnd")


def sphere(centre, radius, material):
    return [f"Translate {text(*centre)}", material, f'Shape "sphere" "float radius" {text(radius)}']


def cloud_points(rng):
    """Centres and radii in a cube about the origin of side 1 in units of the side: no two spheres meet."""
    found = []
    while len(found) < CLOUD_SPHERES:
        radius = rng.uniform(*CLOUD_RADII) / CLOUD_SIDE
        # Later ones are made smaller, so that they find room.
        radius *= 1 - 0.35 * len(found) / CLOUD_SPHERES
        for _ in range(400):
            point = tuple(rng.uniform(radius - 0.5, 0.5 - radius) for _ in range(3))
            if all(math.dist(point, other) > radius + size for other, size in found):
                found.append((point, radius))
                break
    return found


def cloud_colour(point, rng):
    """From blue at the bottom over violet to warm at the top, a little different for each."""
    height = min(max(point[1] + 0.5 + rng.uniform(-0.12, 0.12), 0), 1)
    hue = (0.55 + 0.55 * height) % 1
    return colorsys.hsv_to_rgb(hue, 0.62 - 0.12 * height, 0.62 + 0.28 * height)


def cloud(lines, rng):
    steps = 24
    colours = {}
    body = []
    turn = math.radians(CLOUD_TURN)
    for point, radius in cloud_points(rng):
        kind = rng.random()
        if kind < 0.07:
            name = "cloud glass"
        else:
            colour = tuple(round(c * steps) / steps for c in cloud_colour(point, rng))
            name = colours.setdefault(colour, f"cloud {len(colours)}")
        x, y, z = (CLOUD_SIDE * c for c in point)
        centre = (CLOUD_CENTRE[0] + math.cos(turn) * x + math.sin(turn) * z, CLOUD_CENTRE[1] + y,
                  CLOUD_CENTRE[2] - math.sin(turn) * x + math.cos(turn) * z)
        body.append(f'AttributeBegin Translate {text(*centre)} NamedMaterial "{name}" '
                    f'Shape "sphere" "float radius" {text(CLOUD_SIDE * radius)} AttributeEnd')
    lines.append('MakeNamedMaterial "cloud glass" "string type" "dielectric" "float eta" 1.5')
    for colour, name in colours.items():
        # The named colours are as a screen shows them; reflectances are linear.
        linear = (c ** 2.2 for c in colour)
        lines.append(f'MakeNamedMaterial "{name}" "string type" "diffuse" "rgb reflectance" [ {text(*linear)} ]')
    lines.extend(body)


def main():
    lines = [HEADER]
    lines += [
        'Integrator "path" "integer maxdepth" 9',
        'Sampler "zsobol" "integer pixelsamples" 1000',
        'PixelFilter "gaussian"',
        'Film "rgb" "integer xresolution" 800 "integer yresolution" 800 "string filename" "spheres.exr"',
        "Scale -1 1 1",
        "LookAt 0.4 3.4 10.6  0 1.72 0  0 1 0",
        'Camera "perspective" "float fov" 36 "float shutteropen" 0 "float shutterclose" 1',
        "TransformTimes 0 1",
        "",
        "WorldBegin",
        "",
        "# Ground",
    ]
    block(lines, sphere((0, -1000, 0), 1000, 'Material "diffuse" "rgb reflectance" [ 0.42 0.46 0.5 ]'))
    lines += ["", "# Light"]
    block(lines, ['AreaLightSource "diffuse" "rgb L" [ 5.6 5.1 4.4 ]']
          + sphere((2.6, 9.2, 2.0), 4, 'Material "diffuse" "rgb reflectance" [ 0 0 0 ]'))
    lines += ["", "# Moving sphere: it flies up to the right while the shutter is open"]
    block(lines, ["Translate -0.55 3.95 -0.6", "ActiveTransform EndTime", "Translate 0.62 0.3 0", "ActiveTransform All",
                  'Material "diffuse" "rgb reflectance" [ 0.8 0.28 0.06 ]', 'Shape "sphere" "float radius" 0.42'])
    lines += ["", "# Metal sphere"]
    block(lines, sphere((2.2, 1.3, -1.1), 1.3,
                        'Material "conductor" "rgb reflectance" [ 0.95 0.76 0.46 ] "float roughness" 0'))
    lines += ["", "# Glass sphere"]
    block(lines, sphere((-1.0, 0.8, 2.6), 0.8, 'Material "dielectric" "float eta" 1.5'))
    lines += ["", "# Noise sphere: marble, whose veins turn from white to blue where turbulence is high"]
    lines += [
        "AttributeBegin",
        "  Translate 0.55 0.95 0.9",
        "  AttributeBegin",
        "    Rotate 35 0.3 0 1",
        "    Scale 0.5 0.5 0.5",
        '    Texture "veins" "spectrum" "marble" "float scale" 3.2 "float variation" 1.1 "integer octaves" 8',
        '    Texture "turbulence" "float" "wrinkled" "integer octaves" 7 "float roughness" 0.55',
        "  AttributeEnd",
        '  Texture "blue" "spectrum" "constant" "rgb value" [ 0.03 0.12 0.3 ]',
        '  Texture "noise" "spectrum" "mix" "texture tex1" "veins" "texture tex2" "blue" "texture amount" "turbulence"',
        '  Material "diffuse" "texture reflectance" "noise"',
        '  Shape "sphere" "float radius" 0.95',
        "AttributeEnd",
        "",
        f"# Cloud of {CLOUD_SPHERES} small spheres",
    ]
    cloud(lines, random.Random(1021))
    print("\n".join(lines))


if __name__ == "__main__":
    main()
