#!/usr/bin/env python3
"""Sweeps the roughness of three materials, and puts all images on one contact sheet.

    python3 roughness_sweep.py --output roughness.png

The scene is made from arrays and values. Only a number of a material changes from image to image, so the renderer
builds the scene once.
"""

import argparse
import io
from pathlib import Path

import matplotlib
import numpy as np

import alhazen

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

MATERIALS = {
    "gold": alhazen.Principled(base_color=(1, 0.77, 0.34), metallic=1),
    "plastic": alhazen.Principled(base_color=(0.55, 0.02, 0.03)),
    "glass": alhazen.Principled(transmission=1, ior=1.5),
}


def ball_on_a_floor():
    scene = alhazen.Scene()
    floor = alhazen.Mesh([[-40, 0, 40], [40, 0, 40], [40, 0, -40], [-40, 0, -40]], [[0, 1, 2], [0, 2, 3]],
                         uvs=[[0, 0], [80, 0], [80, 80], [0, 80]])
    checks = alhazen.CheckerboardTexture(even=0.55, odd=0.12)
    scene.add(floor, material=alhazen.Principled(base_color=checks, roughness=0.6))
    ball = scene.add(alhazen.Sphere(1), transform=alhazen.Transform.translate((0, 1, 0)), name="ball")
    scene.environment = Path(__file__).resolve().parents[2] / "scenes" / "sky.hdr"
    scene.camera.look_at((0, 2.1, 6.5), (0, 0.92, 0))
    scene.camera.fov = 22
    return scene, ball


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=6, help="values of the roughness, from 0 to 0.75")
    parser.add_argument("--samples", type=int, default=128, help="per pixel, before denoising")
    parser.add_argument("--size", type=int, default=160, help="pixels of each side of an image")
    parser.add_argument("--output", type=Path, default=Path("roughness.png"))
    options = parser.parse_args()

    scene, ball = ball_on_a_floor()
    renderer = alhazen.Renderer(size=(options.size, options.size), spp=options.samples, denoiser="auto")
    figure, axes = plt.subplots(len(MATERIALS), options.steps, squeeze=False, dpi=100, layout="constrained",
                                figsize=(options.steps * options.size / 96, len(MATERIALS) * options.size / 92))
    for row, (name, material) in zip(axes, MATERIALS.items()):
        ball.material = material.replace(name=name)
        for axis, roughness in zip(row, np.linspace(0, 0.75, options.steps)):
            scene.materials[name].roughness = roughness
            image = renderer.render(scene)
            axis.imshow(plt.imread(io.BytesIO(image.png(tone_map="filmic"))))
            axis.set(xticks=[], yticks=[])
            axis.set_frame_on(False)
            print(f"{name}, roughness {roughness:.2f}: brightest pixel {np.max(image):.4g}")
        row[0].set_ylabel(name)
    for axis, roughness in zip(axes[-1], np.linspace(0, 0.75, options.steps)):
        axis.set_xlabel(f"{roughness:.2g}")
    figure.savefig(options.output)
    print(f"{options.output}: {axes.size} images")


if __name__ == "__main__":
    main()
