#!/usr/bin/env python3
"""What path guiding gains, as a table (docs/guiding.md).

  measure-guiding.py --program BIN [--scenes DIR] [--spp 256] [--seeds 2] [SCENE ...]

Renders each scene without guiding, with it, and with `auto`, from several seeds, and prints for each mode the time of
its samples on all cores and the variance of its images as multiples of those without guiding. The variance is the mean
over pixels and channels of (a - b)^2 / 2 between images of two seeds, relative to the square of their mean plus 0.01;
the 0.1 % of pixels where it is largest are left out, as few bright paths would decide. The product of both, inverted, is
the gain at equal time. DIR holds scenes by other authors, as for equal-time.py; those that are missing are skipped.
"""

import argparse
import array
import datetime
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = {
    "veach-bidir": ("pbrt/veach-bidir/scene-v4.pbrt", "200x200"),
    "kitchen": ("pbrt/kitchen/scene-v4.pbrt", "256x144"),
    "staircase2": ("pbrt/staircase2/staircase2.pbrt", "200x200"),
    "window": ("scenes/window.pbrt", "256x144"),
    "cornell-glass": ("scenes/cornell-glass.pbrt", "200x200"),
    "spheres": ("scenes/spheres.pbrt", "200x200"),
    "weekend": ("scenes/weekend.pbrt", "256x144"),
    "mesh": ("scenes/mesh.pbrt", "240x160"),
    "cornell": ("scenes/cornell.pbrt", "200x200"),
}
MODES = ("off", "on", "auto")


def render(program: str, scene: pathlib.Path, size: str, spp: int, seed: int, mode: str, folder: str):
    """The values of an image, the processor seconds of its samples, and whether they were guided to the end."""
    image = pathlib.Path(folder) / "image.pfm"
    run = subprocess.run(
        [program, "render", str(scene), "--size", size, "--spp", str(spp), "--seed", str(seed), "--guiding", mode, "-o",
         str(image), "--stats=json", "-q", "--progress", "none"], capture_output=True, text=True)  # fmt: skip
    if run.returncode != 0:
        sys.exit(f"measure-guiding: {scene}: {run.stderr.strip()}")
    statistics = json.loads(run.stdout)
    seconds = sum(thread["busy_seconds"] for thread in statistics["thread_statistics"])
    values = array.array("f", image.read_bytes().split(b"\n", 3)[3])
    return values, seconds, statistics.get("guiding", {}).get("used", False)


def variance(images: list) -> float:
    """Trimmed, of images that differ in their seed."""
    sums = [0.0] * (len(images[0]) // 3)
    pairs = list(itertools.combinations(images, 2))
    for first, second in pairs:
        for i, (a, b) in enumerate(zip(first, second)):
            mean = (a + b) / 2
            sums[i // 3] += (a - b) ** 2 / 2 / (mean * mean + 0.01)
    sums.sort()
    kept = sums[: len(sums) - len(sums) // 1000]
    return sum(kept) / len(kept) / len(pairs)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--scenes", type=pathlib.Path, default=ROOT)
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("names", nargs="*", metavar="SCENE")
    options = parser.parse_args()
    print(f"{datetime.date.today()}, {options.spp} samples per pixel, {options.seeds} seeds.\n")
    print("| scene | variance, `on` | time | gain at equal time | `auto` | its gain |\n|---|---|---|---|---|---|")
    for name, (file, size) in SCENES.items():
        if options.names and name not in options.names:
            continue
        scene = (ROOT if file.startswith("scenes/") else options.scenes) / file
        if not scene.exists():
            print(f"measure-guiding: {scene} is not there: skipped", file=sys.stderr)
            continue
        found = {}
        with tempfile.TemporaryDirectory() as folder:
            for mode in MODES:
                runs = [render(options.program, scene, size, options.spp, 100 + s, mode, folder)
                        for s in range(options.seeds)]  # fmt: skip
                found[mode] = (variance([r[0] for r in runs]), sum(r[1] for r in runs), runs[0][2])
        (v0, t0, _), (v1, t1, _), (v2, t2, used) = (found[mode] for mode in MODES)
        print(f"| {name} | {v1 / v0:.2f} | {t1 / t0:.2f} | {v0 * t0 / (v1 * t1):.2f} | "
              f"{'guided' if used else 'ended'} | {v0 * t0 / (v2 * t2):.2f} |", flush=True)


if __name__ == "__main__":
    main()
