#!/usr/bin/env python3
"""Error at equal time of two methods of finding light, as Markdown tables (docs/results/lights.md).

  light-study.py lights        a room of 1 to 100000 lights: the light tree against a choice by power alone
  light-study.py scenes DIR    `path` against `iterative` on scenes of DIR, the folder of test scenes
  light-study.py sky MAP       sampling an environment map against BSDF sampling alone

The error of an image falls as 1 / sqrt(samples), so for two methods with equal samples the mean squared error times
the seconds says which is better at equal time: their ratio is how many times as long the worse one has to run.
"""

import argparse
import json
import os
import pathlib
import random
import subprocess
import tempfile

FLOOR = """Material "diffuse" "rgb reflectance" [ 0.7 0.7 0.7 ]
Shape "trianglemesh" "point3 P" [ -5 0 -5  5 0 -5  5 0 5  -5 0 5 ] "integer indices" [ 0 2 1 0 3 2 ]
Shape "trianglemesh" "point3 P" [ -5 0 5  5 0 5  5 4 5  -5 4 5 ] "integer indices" [ 0 2 1 0 3 2 ]
Shape "trianglemesh" "point3 P" [ -5 0 -5  -5 0 5  -5 4 5  -5 4 -5 ] "integer indices" [ 0 2 1 0 3 2 ]
Shape "trianglemesh" "point3 P" [ 5 0 -5  5 0 5  5 4 5  5 4 -5 ] "integer indices" [ 0 1 2 0 2 3 ]
AttributeBegin Translate -1.5 0.8 1 Shape "sphere" "float radius" 0.8 AttributeEnd
AttributeBegin Material "conductor" "rgb reflectance" [ 0.9 0.8 0.6 ] "float roughness" 0.1
Translate 1.5 0.8 0 Shape "sphere" "float radius" 0.8 AttributeEnd
"""


def room(count: int, sampler: str) -> str:
    """A room with that many small lamps, randomly oriented triangles of constant total power, out of sight."""
    rng = random.Random(count)
    size = 0.5 / count**0.5
    points = []
    for _ in range(count):
        p = [rng.uniform(-4.5, 4.5), rng.uniform(2.6, 3.8), rng.uniform(-4.5, 4.5)]
        for _ in range(3):
            points += [x + rng.uniform(-size, size) for x in p]
    head = f"""LookAt 0 2.4 -4.9  0 0 0.5  0 1 0
Camera "perspective" "float fov" 50
Film "rgb" "integer xresolution" 160 "integer yresolution" 90
Sampler "independent" "integer pixelsamples" 16
Integrator "path" "integer maxdepth" 3 "string lightsampler" "{sampler}"
WorldBegin
"""
    lamps = 'AreaLightSource "diffuse" "rgb L" [ 600 500 400 ] "bool twosided" true\nShape "trianglemesh" "point3 P" [ '
    lamps += " ".join(f"{x:.6f}" for x in points) + ' ] "integer indices" [ '
    lamps += " ".join(str(i) for i in range(3 * count)) + " ]\n"
    return head + FLOOR + lamps


def open_room(image: str) -> str:
    """The room without lamps, under a map scaled by 30, with its top upwards."""
    lamps = "AreaLightSource"
    head = room(1, "power").split(lamps)[0]
    return head + f'Rotate -90 1 0 0 LightSource "infinite" "string filename" "{image}" "float scale" 30\n'


class Study:
    def __init__(self, options):
        self.options = options
        self.folder = tempfile.TemporaryDirectory()

    def path(self, name: str) -> str:
        return str(pathlib.Path(self.folder.name) / name)

    def render(self, scene: str, output: str, samples: int, extra: list[str]) -> float:
        """Processor seconds, which do not depend on other programs of a busy machine."""
        command = [self.options.alhazen, "render", scene, "-o", output, "--exr-type", "float", "--spp", str(samples)]
        command += ["--stats=json", "-q", *extra]
        if self.options.threads:
            command += ["-t", str(self.options.threads)]
        before = os.times()
        subprocess.run(command, check=True, capture_output=True, text=True)
        after = os.times()
        return after.children_user - before.children_user

    def error(self, a: str, b: str) -> float:
        result = subprocess.run([self.options.alhazen, "compare", "--json", a, b], capture_output=True, text=True)
        return json.loads(result.stdout)[self.options.metric]

    def contest(self, name: str, methods: dict[str, tuple[str, list[str]]], samples: int, reference: int) -> None:
        """`methods`: scene and options by name; the reference is made by the first."""
        first, options = next(iter(methods.values()))
        self.render(first, self.path("reference.exr"), reference, ["--seed", "99", *options])
        cells, costs = [], []
        for scene, options in methods.values():
            # The cost of reading the scene and of one sample is subtracted.
            start = self.render(scene, self.path("image.exr"), 1, options)
            errors, seconds = [], []
            for seed in range(1, self.options.repeats + 1):
                seconds.append(self.render(scene, self.path("image.exr"), samples, ["--seed", str(seed), *options]))
                errors.append(self.error(self.path("image.exr"), self.path("reference.exr")))
            error, time = sum(errors) / len(errors), (min(seconds) - start) * samples / (samples - 1)
            cells += [f"{error:.3g}", f"{time:.2f}"]
            costs.append(error * time)
        print(f"| {name} | " + " | ".join(cells) + f" | {costs[1] / costs[0]:.3g} |", flush=True)


def header(first: str, a: str, b: str) -> None:
    print(f"| {first} | error, {a} | s, {a} | error, {b} | s, {b} | {b} takes ... times as long |")
    print("|---|---|---|---|---|---|")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", choices=["lights", "scenes", "sky"])
    parser.add_argument("folder", nargs="?")
    parser.add_argument("--alhazen", default="build/release/bin/alhazen")
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--samples", type=int, default=16)
    parser.add_argument("--reference", type=int, default=1024, help="samples per pixel of the reference")
    parser.add_argument("--metric", default="relmse", help="name of the error in `alhazen compare --json`")
    parser.add_argument("--size", default="160x90")
    options = parser.parse_args()
    study = Study(options)
    size = ["--size", options.size]
    if options.study == "lights":
        header("lights", "tree", "power")
        for count in (1, 3, 10, 30, 1000, 100_000):
            methods = {}
            for sampler in ("bvh", "power"):
                path = study.path(f"{sampler}-{count}.pbrt")
                pathlib.Path(path).write_text(room(count, sampler))
                methods[sampler] = (path, size)
            study.contest(str(count), methods, options.samples, options.reference)
    elif options.study == "sky":
        header("scene", "light sampling", "BSDF sampling")
        path = study.path("sky.pbrt")
        pathlib.Path(path).write_text(open_room(str(pathlib.Path(options.folder).resolve())))
        methods = {"path": (path, size), "iterative": (path, [*size, "--integrator", "iterative"])}
        study.contest(pathlib.Path(options.folder).stem, methods, options.samples, options.reference)
    else:
        header("scene", "path", "iterative")
        folder = pathlib.Path(options.folder)
        many = study.path("many.pbrt")
        pathlib.Path(many).write_text(room(1000, "bvh"))
        sky = study.path("sky.pbrt")
        pathlib.Path(sky).write_text(open_room(str((folder / "hdr/grace_latlong/grace_latlong.exr").resolve())))
        scenes = {
            "cornell-box": (str(next(folder.glob("pbrt/cornell-box/**/*.pbrt"))), ["--size", "96x96"]),
            "veach-bidir": (str(next(folder.glob("pbrt/veach-bidir/**/*.pbrt"))), ["--size", "128x72"]),
            "room under grace_latlong": (sky, size),
            "room of 1000 lights": (many, size),
        }
        for name, (scene, extra) in scenes.items():
            methods = {"path": (scene, extra), "iterative": (scene, [*extra, "--integrator", "iterative"])}
            study.contest(name, methods, options.samples, options.reference)


if __name__ == "__main__":
    main()
