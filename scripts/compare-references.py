#!/usr/bin/env python3
"""Compares scenes with reference images from other renderers, as a Markdown table (docs/results/references.md).

  compare-references.py FOLDER... [--spp 8] [--reduce 4] [--only NAME...] [--output DIR]

Every folder below FOLDER that holds TungstenRender.exr and a pbrt file is a scene. It is rendered at the size of its
reference, with its own filter, with few samples; then both images are averaged over blocks of pixels
(`alhazen compare --reduce`), which removes most of the noise and leaves the differences.
"""

import argparse
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import time

REFERENCE = "TungstenRender.exr"


def scenes(folders: list[str]) -> list[tuple[pathlib.Path, pathlib.Path]]:
    """Pairs of a scene and its reference, by name."""
    found = []
    for folder in folders:
        for reference in sorted(pathlib.Path(folder).rglob(REFERENCE)):
            files = sorted(reference.parent.glob("*.pbrt"))
            v4 = [f for f in files if "v4" in f.name or f.stem == reference.parent.name]
            if v4 or files:
                found.append(((v4 or files)[0], reference))
    return found


def name_of(scene: pathlib.Path) -> str:
    return scene.parent.parent.name if scene.parent.name == "pbrt" else scene.parent.name


def size_of(image: pathlib.Path) -> str:
    """WxH of an EXR: its header has the data window as two inclusive corners."""
    header = image.read_bytes()[:65536]
    at = header.index(b"dataWindow\0box2i\0") + len(b"dataWindow\0box2i\0") + 4
    x0, y0, x1, y1 = struct.unpack("<4i", header[at : at + 16])
    return f"{x1 - x0 + 1}x{y1 - y0 + 1}"


def run(command: list[str]) -> subprocess.CompletedProcess:
    return subprocess.run(command, capture_output=True, text=True)


class Study:
    def __init__(self, options: argparse.Namespace, work: pathlib.Path):
        self.options = options
        self.work = work

    def row(self, scene: pathlib.Path, reference: pathlib.Path) -> str:
        name = name_of(scene)
        image, small = self.work / f"{name}.exr", self.work / f"{name}.png"
        start = time.time()
        rendered = run([self.options.alhazen, "render", str(scene), "-o", str(image), "-o", str(small), "-q",
                        "--size", size_of(reference), "--spp", str(self.options.spp), "--threads", str(self.options.threads),
                        *self.options.render])  # fmt: skip
        seconds = time.time() - start
        (self.work / f"{name}.log").write_text(rendered.stderr)
        if rendered.returncode != 0:
            return f"| {name} | {rendered.stderr.strip().splitlines()[0] if rendered.stderr else 'failed'} |"
        compared = run([self.options.alhazen, "compare", str(image), str(reference), "--json", "--reduce",
                        str(self.options.reduce), "--diff", str(self.work / f"{name}-diff.png")])  # fmt: skip
        if compared.returncode != 0:
            return f"| {name} | {compared.stderr.strip().splitlines()[0]} |"
        d = json.loads(compared.stdout)
        ratio = d["mean_a"] / d["mean_b"] if d["mean_b"] > 0 else float("nan")
        return f"| {name} | {ratio:.3f} | {d['relmse']:.4f} | {d['flip']:.3f} | {seconds:.0f} |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", metavar="FOLDER")
    parser.add_argument("--alhazen", default="build/release/bin/alhazen", help="the program")
    parser.add_argument("--spp", type=int, default=8, help="samples per pixel of the whole image")
    parser.add_argument("--reduce", type=int, default=4, help="average blocks of this many pixels per side")
    parser.add_argument("--only", nargs="*", default=[], help="names of scenes")
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--output", help="keep the images, difference images and warnings here")
    parser.add_argument("--render", nargs="*", default=[], help="more options of `alhazen render`")
    options = parser.parse_args()
    print("| scene | mean luminance / reference | relMSE | FLIP | seconds |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as scratch:
        work = pathlib.Path(options.output or scratch)
        work.mkdir(parents=True, exist_ok=True)
        study = Study(options, work)
        for scene, reference in scenes(options.folders):
            if not options.only or name_of(scene) in options.only:
                print(study.row(scene, reference), flush=True)


if __name__ == "__main__":
    sys.exit(main())
