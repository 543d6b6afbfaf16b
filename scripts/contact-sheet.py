#!/usr/bin/env python3
"""Renders every scene of a folder at a small size and puts the images with their names on one sheet.

  scripts/contact-sheet.py FOLDER SHEET.png [--build build/release] [--size 192] [--spp 16] [--seconds 20] [--only TEXT]
                           [-- further options of `alhazen render`]

Scenes are the .gltf, .glb and .pbrt files below FOLDER. One that fails is on the sheet with its message, and makes the
exit code 1.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent


def render(binary, scene, image, options):
    """The error message, or nothing; and the warnings."""
    command = [str(binary), "render", str(scene), "-q", "-o", str(image), "--size", f"{options.size}x{options.size}",
               "--spp", str(options.spp), "--time-limit", str(options.seconds), *options.further]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=10 * options.seconds + 60, check=False)
    except subprocess.TimeoutExpired:
        return "it took too long", ""
    message = done.stderr.strip()
    return (message or f"exit code {done.returncode}", "") if done.returncode else ("", message)


def name_of(scene, folder):
    """The folder of the scene if it is the only one there, else the path."""
    relative = scene.relative_to(folder)
    siblings = [p for p in scene.parent.iterdir() if p.suffix in {".gltf", ".glb", ".pbrt"}]
    return str(relative.parent if len(siblings) == 1 and len(relative.parts) > 1 else relative.with_suffix(""))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("sheet", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--size", type=int, default=192)
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--seconds", type=float, default=20, help="time limit for rendering each scene")
    parser.add_argument("--columns", type=int, default=8)
    parser.add_argument("--only", default="", help="scenes whose path contains this text")
    arguments = sys.argv[1:]
    at = arguments.index("--") if "--" in arguments else len(arguments)
    options = parser.parse_args(arguments[:at])
    options.further = arguments[at + 1:]

    scenes = sorted(p for p in options.folder.rglob("*")
                    if p.suffix in {".gltf", ".glb", ".pbrt"} and options.only in str(p))
    if not scenes:
        sys.exit(f"contact-sheet: there is no scene below {options.folder}")
    columns = min(options.columns, len(scenes))
    rows = -(-len(scenes) // columns)
    inches = options.size / 96
    figure, axes = plt.subplots(rows, columns, figsize=(columns * inches, rows * (inches + 0.25)), squeeze=False)
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        for i, axis in enumerate(axes.flat):
            axis.axis("off")
            if i >= len(scenes):
                continue
            image = pathlib.Path(folder) / f"{i}.png"
            error, warnings = render(options.build / "bin" / "alhazen", scenes[i], image, options)
            name = name_of(scenes[i], options.folder)
            axis.set_title(name[-32:], fontsize=6, pad=2)
            if error:
                failures += 1
                axis.text(0.5, 0.5, error[:200], fontsize=5, ha="center", va="center", wrap=True)
            else:
                axis.imshow(plt.imread(image))
            if error or warnings:
                print(f"{name}: {error or warnings}", flush=True)
    figure.subplots_adjust(0.005, 0.005, 0.995, 1 - 0.25 / (rows * (inches + 0.25)), 0.02, 0.25 / inches * 0.6)
    figure.savefig(options.sheet, dpi=96)
    print(f"{len(scenes)} scenes, {failures} failed; wrote {options.sheet}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
