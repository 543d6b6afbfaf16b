#!/usr/bin/env python3
"""Asks rays what they hit, by NumPy alone: a depth map and ambient occlusion, without a renderer.

    python3 ray_queries.py ../../scenes/studio.glb

It writes rays-depth.png and rays-occlusion.png.
"""

import argparse
from pathlib import Path

import numpy as np

import alhazen

STUDIO = Path(__file__).resolve().parents[2] / "scenes" / "studio.glb"


def camera_rays(camera, width, height):
    """Origin and directions (height, width, 3) of rays through the middles of all pixels, in world space."""
    y, x = np.indices((height, width), dtype=np.float32) + 0.5
    half = np.tan(np.radians(camera.fov) / 2) / min(width, height)  # fov is over the shorter side
    directions = np.stack([half * (2 * x - width), half * (height - 2 * y), np.ones_like(x)], axis=-1)
    matrix = camera.transform.astype(np.float32)
    return matrix[:3, 3], directions @ matrix[:3, :3].T


def cosine_directions(normals, random):
    """A unit direction about each normal, with a density in proportion to the cosine."""
    points = random.normal(size=normals.shape).astype(np.float32)
    directions = normals + 0.999 * points / np.linalg.norm(points, axis=-1, keepdims=True)
    return directions / np.linalg.norm(directions, axis=-1, keepdims=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="?", default=STUDIO, help="a scene file (default: studio.glb)")
    parser.add_argument("--size", type=lambda text: tuple(map(int, text.split("x"))), default=(640, 360), metavar="WxH")
    parser.add_argument("--samples", type=int, default=64, help="rays of each pixel for the occlusion")
    parser.add_argument("--distance", type=float, default=1.5, help="of what occludes, in scene units")
    parser.add_argument("--output", default="rays", help="how the names of the files begin")
    options = parser.parse_args()
    width, height = options.size

    scene = alhazen.load(options.scene)
    origin, directions = camera_rays(scene.camera, width, height)
    hits = scene.intersect(origin, directions)

    # Directions have the length 1 along the camera's axis, so t is the depth.
    inverse = 1 / hits.t  # 0 after a miss
    far, near = inverse[hits.hit].min(), inverse[hits.hit].max()
    shown = np.where(hits.hit, 0.05 + 0.95 * (inverse - far) / (near - far), 0)
    alhazen.RenderedImage(shown ** 2).save(f"{options.output}-depth.png")

    side = np.sign(-np.sum(directions * hits.normal, axis=-1, keepdims=True))  # towards the camera
    start = (hits.position + side * hits.offset[..., None] * hits.normal)[hits.hit]
    normals = (side * hits.shading_normal)[hits.hit]
    random = np.random.default_rng(1)
    free = np.zeros(len(start), np.float32)
    for _ in range(options.samples):
        free += ~scene.occluded(start, cosine_directions(normals, random), t_max=options.distance)
    visible = np.zeros((height, width), np.float32)
    visible[hits.hit] = free / options.samples
    alhazen.RenderedImage(visible).save(f"{options.output}-occlusion.png")
    print(f"{hits.hit.mean():.0%} of the rays hit something; {1 - visible[hits.hit].mean():.0%} of the sky is occluded")


if __name__ == "__main__":
    main()
