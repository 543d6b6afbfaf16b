#!/usr/bin/env python3
"""What denoising gains (docs/denoising.md): FLIP and relMSE of noisy and denoised images against references.

  measure-denoising.py [--program BIN] [--denoiser builtin] [--samples 16,128] [--only NAMES] [--shared DIR]
                       [--work DIR]

Scenes of the repository, and of the folder `--shared` as far as they are there, are rendered small. The reference has
many samples of another seed. `ratio` is the noisy image's mean FLIP over the denoised one's: above 1 denoising is a
gain. References, and checkpoints of the noisy renders, are kept in `--work`, so that another run only denoises; what
they were made with must not change. Needs numpy.
"""

import argparse
import importlib.util
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

import numpy

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Name: file, size, samples of the reference.
SCENES = {"cornell": ("cornell.pbrt", "240x240", 1024), "cornell-glass": ("cornell-glass.pbrt", "240x240", 1024),
          "weekend": ("weekend.pbrt", "320x180", 2048), "studio": ("studio.glb", "320x180", 1024)}  # fmt: skip
SHARED = {"veach-mis": ("pbrt/veach-mis/scene-v4.pbrt", "320x180", 2048),
          "FlightHelmet": ("gltf/FlightHelmet/FlightHelmet.gltf", "240x240", 2048)}  # fmt: skip


def load_script(name: str):
    spec = importlib.util.spec_from_file_location("script", ROOT / "scripts" / name)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


read_exr = load_script("measure-noise.py").read_exr


def write_pfm(path: pathlib.Path, image: numpy.ndarray) -> None:
    height, width = image.shape[:2]
    path.write_bytes(f"PF\n{width} {height}\n-1\n".encode() + image[::-1].astype("<f4").tobytes())


class Study:
    def __init__(self, options: argparse.Namespace, work: pathlib.Path):
        self.options, self.work = options, work

    def render(self, scene: pathlib.Path, image: pathlib.Path, size: str, samples: int, *more: str) -> None:
        command = [self.options.program, "render", str(scene), "-q", "--exr-type", "float", "--size", size,
                   "--spp", str(samples), "-t", str(self.options.threads), "-o", str(image), *more]  # fmt: skip
        result = subprocess.run(command, capture_output=True, text=True)
        if result.returncode != 0:
            sys.exit(result.stderr)

    def compare(self, image: pathlib.Path, reference: pathlib.Path) -> dict:
        command = [self.options.program, "compare", "--json", str(image), str(reference)]
        return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)

    def reference(self, name: str, scene: pathlib.Path, size: str, samples: int) -> pathlib.Path:
        image = self.work / f"{name}-{samples}-reference.exr"
        if not image.exists():
            self.render(scene, image, size, samples, "--seed", "777", "-o", str(image.with_suffix(".png")))
        return image

    def row(self, name: str, scene: pathlib.Path, size: str, samples: int, of_reference: int) -> float:
        reference = self.reference(name, scene, size, of_reference)
        stem = f"{name}-{samples}"
        state, noisy = self.work / f"{stem}.state", self.work / f"{stem}-noisy.pfm"
        denoised = self.work / f"{stem}-{self.options.denoiser}.exr"
        self.render(scene, denoised, size, samples, "--denoise", self.options.denoiser, "--aov", "noisy",
                    "--checkpoint", str(state), *(["--resume"] if state.exists() else []),
                    "-o", str(denoised.with_suffix(".png")))  # fmt: skip
        layers = read_exr(denoised)
        write_pfm(noisy, numpy.stack([layers[f"noisy.{channel}"] for channel in "RGB"], axis=-1))
        before, after = self.compare(noisy, reference), self.compare(denoised, reference)
        ratio = before["flip"] / after["flip"]
        print(f"| {name} | {samples} | {before['flip']:.4f} | {after['flip']:.4f} | {ratio:.2f} "
              f"| {before['relmse']:.2g} | {after['relmse']:.2g} | {before['relmse'] / after['relmse']:.1f} |",
              flush=True)  # fmt: skip
        return ratio


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build/release/bin/alhazen"))
    parser.add_argument("--denoiser", default="builtin")
    parser.add_argument("--samples", default="16,128")
    parser.add_argument("--only", default="")
    parser.add_argument("--shared", default=str(ROOT.parent / "shared/scenes"))
    parser.add_argument("--work", default="", help="keep images and checkpoints here")
    parser.add_argument("--threads", type=int, default=0)
    options = parser.parse_args()
    scenes = {name: (ROOT / "scenes" / scene[0], *scene[1:]) for name, scene in SCENES.items()}
    scenes |= {name: (pathlib.Path(options.shared) / scene[0], *scene[1:]) for name, scene in SHARED.items()}
    only = options.only.split(",") if options.only else list(scenes)
    with tempfile.TemporaryDirectory() as temporary:
        work = pathlib.Path(options.work or temporary)
        work.mkdir(parents=True, exist_ok=True)
        study = Study(options, work)
        print("| scene | samples | FLIP: noisy | denoised | ratio | relMSE: noisy | denoised | ratio |")
        print("|---|---|---|---|---|---|---|---|")
        for samples in map(int, options.samples.split(",")):
            ratios = [study.row(name, scenes[name][0], scenes[name][1], samples, scenes[name][2])
                      for name in only if scenes[name][0].exists()]  # fmt: skip
            print(f"| median | {samples} | | | {statistics.median(ratios):.2f} | | | |", flush=True)


if __name__ == "__main__":
    main()
