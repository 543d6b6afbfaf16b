#!/usr/bin/env python3
"""Renders training pictures of one scene, with depth, normals, instance ids and cameras.

    python3 dataset.py --count 1000 --output dataset

Camera, light and two colors are other ones in each picture. Beside images/*.png it writes layers/*.npz, with the arrays
depth, normal and object of docs/layers.md, and annotations.json: COCO's images, annotations, and categories, whose
numbers are those in the layer object.

A point p of the world is seen at K (R p + t) / z, with K the intrinsics and [R t] world_to_camera of an image. The axes
are those of OpenCV: x to the right, y down, z forward. The middle of the top left pixel is (0.5, 0.5).
"""

import argparse
import json
from pathlib import Path

import numpy as np

import alhazen

STUDIO = Path(__file__).resolve().parents[2] / "scenes" / "studio.glb"


def matrices(camera, width, height):
    focal = 0.5 * min(width, height) / np.tan(np.radians(camera.fov) / 2)  # fov is over the shorter side
    world_to_camera = np.diag([1, -1, 1, 1]) @ np.linalg.inv(camera.transform)
    return {"intrinsics": [[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1]],
            "world_to_camera": world_to_camera.tolist()}


def annotations(ids, image, first):
    for number, category in enumerate(np.unique(ids[ids > 0])):
        mask = ids == category
        rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
        changes = np.flatnonzero(np.diff(mask.ravel(order="F"), prepend=False, append=False))
        counts = np.diff(changes, prepend=0, append=mask.size)
        yield {"id": first + number, "image_id": image, "category_id": int(category), "iscrowd": 0,
               "area": int(mask.sum()), "segmentation": {"size": list(mask.shape), "counts": counts.tolist()},
               "bbox": [int(columns[0]), int(rows[0]), int(np.ptp(columns)) + 1, int(np.ptp(rows)) + 1]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=1000, help="pictures")
    parser.add_argument("--samples", type=int, default=32, help="per pixel, before denoising")
    parser.add_argument("--size", type=lambda text: tuple(map(int, text.split("x"))), default=(320, 240), metavar="WxH")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--output", type=Path, default=Path("dataset"))
    options = parser.parse_args()
    random = np.random.default_rng(options.seed)
    (options.output / "images").mkdir(parents=True, exist_ok=True)
    (options.output / "layers").mkdir(exist_ok=True)

    scene = alhazen.load(STUDIO)
    names = dict.fromkeys(shape.name for shape in scene.shapes)  # object 1 is the first
    categories = [{"id": number, "name": name} for number, name in enumerate(names, 1)]
    coco = {"images": [], "annotations": [], "categories": categories}
    layers = ["depth", "normal", "object"]
    renderer = alhazen.Renderer(size=options.size, spp=options.samples, denoiser="auto", layers=layers)
    for number in range(options.count):
        scene.camera.orbit(random.uniform(-60, 60), random.uniform(5, 50), distance=random.uniform(6, 10))
        scene.environment = random.uniform(0, 0.3, size=3)
        for material in ("red lacquer", "glaze"):
            scene.materials[material].base_color = random.uniform(0.02, 0.8, size=3)
        image = renderer.render(scene)
        picture, arrays, ids = f"images/{number:06d}.png", f"layers/{number:06d}.npz", image["object"].astype(np.uint8)
        image.save(options.output / picture)
        np.savez_compressed(options.output / arrays, object=ids, depth=image["depth"], normal=image["normal"])
        coco["images"].append({"id": number, "file_name": picture, "layers": arrays,
                               "width": image.width, "height": image.height, **matrices(scene.camera, *options.size)})
        coco["annotations"].extend(annotations(ids, number, first=len(coco["annotations"]) + 1))
    (options.output / "annotations.json").write_text(json.dumps(coco, indent=1))
    print(f"{options.count} pictures and {len(coco['annotations'])} annotations are in {options.output}")


if __name__ == "__main__":
    main()
