#!/usr/bin/env python3
"""How well a noise target is met (docs/noise.md): target, measured error, samples and time, and FLIP at equal samples.

  measure-noise.py [--program BIN] [--targets 0.1,0.05] [--only NAMES]

Every scene of the repository is rendered with each target by several seeds, and compared with a reference: the mean of
uniform renders by other seeds, together `--reference` samples per pixel. The error of a pixel is that of its luminance,
relative to the luminance of the reference or, where that is darker, to a tenth of the mean of the image without its
brightest hundredth, as in the estimate. Its mean square over pixels and seeds has the reference's own variance
subtracted, which the spread of the reference's parts gives. Pixels that got the fewest samples or the most are left out
of `decided`: there the target decided nothing.

FLIP is the 95th percentile of tiles of 8 x 8 pixels of the error in what is displayed (the difference of sRGB grey),
of a uniform render with as many samples as the other took in the mean, over that of the other. Needs numpy.
"""

import argparse
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = {"cornell": ("cornell.pbrt", 1), "cornell-glass": ("cornell-glass.pbrt", 1), "spheres": ("spheres.pbrt", 1),
          "weekend": ("weekend.pbrt", 16 / 9), "mesh": ("mesh.pbrt", 1.5), "window": ("window.pbrt", 16 / 9),
          "panel": ("panel.pbrt", 16 / 9), "studio": ("studio.glb", 16 / 9)}  # fmt: skip
LUMINANCE = {"R": 0.2126390, "G": 0.7151687, "B": 0.0721923}
FEWEST = 16


def read_exr(path: pathlib.Path) -> dict[str, numpy.ndarray]:
    """The float channels of an EXR of scanlines with ZIP compression, as `alhazen render --exr-type float` writes."""
    data = path.read_bytes()
    at, channels, window, compression = 8, [], None, None
    while data[at]:
        name, kind, rest = data[at:].split(b"\0", 2)[0], data[at:].split(b"\0", 2)[1], None
        at += len(name) + len(kind) + 2
        (size,) = struct.unpack_from("<i", data, at)
        rest, at = data[at + 4 : at + 4 + size], at + 4 + size
        if name == b"channels":
            while rest[0]:
                channel, rest = rest.split(b"\0", 1)
                assert struct.unpack_from("<i", rest)[0] == 2, "float channels are wanted: --exr-type float"
                channels.append(channel.decode())
                rest = rest[16:]
        elif name == b"dataWindow":
            window = struct.unpack("<4i", rest)
        elif name == b"compression":
            compression = rest[0]
    lines = {0: 1, 2: 1, 3: 16}[compression]
    width, height = window[2] - window[0] + 1, window[3] - window[1] + 1
    image = numpy.empty((height, len(channels), width), "<f4")
    offsets = struct.unpack_from(f"<{(height + lines - 1) // lines}Q", data, at + 1)
    for offset in offsets:
        y, size = struct.unpack_from("<ii", data, offset)
        y -= window[1]
        rows = min(lines, height - y)
        block = data[offset + 8 : offset + 8 + size]
        if size < rows * len(channels) * width * 4:
            packed = numpy.frombuffer(zlib.decompress(block), numpy.uint8).astype(numpy.int64)
            packed[1:] -= 128
            plain = (numpy.cumsum(packed) & 255).astype(numpy.uint8)
            half = (len(plain) + 1) // 2
            mixed = numpy.empty_like(plain)
            mixed[0::2], mixed[1::2] = plain[:half], plain[half:]
            block = mixed.tobytes()
        image[y : y + rows] = numpy.frombuffer(block, "<f4").reshape(rows, len(channels), width)
    return {channel: image[:, i].astype(float) for i, channel in enumerate(channels)}


def luminance(image: dict[str, numpy.ndarray]) -> numpy.ndarray:
    return sum(weight * image[channel] for channel, weight in LUMINANCE.items())


class Renders:
    def __init__(self, options: argparse.Namespace, folder: pathlib.Path):
        self.options, self.folder = options, folder

    def render(self, scene: str, seed: int, samples: int, *more: str) -> tuple[numpy.ndarray, numpy.ndarray, dict]:
        """Luminance and samples of every pixel, and statistics."""
        file, aspect = SCENES[scene]
        size = f"{round(math.sqrt(self.options.pixels * aspect))}x{round(math.sqrt(self.options.pixels / aspect))}"
        image = self.folder / "image.exr"
        command = [self.options.program, "render", str(ROOT / "scenes" / file), "--size", size, "--seed", str(seed),
                   "--spp", str(samples), "-o", str(image), "--exr-type", "float", "--aov", "samples", "--stats=json",
                   "-q", "--progress", "none", *more, *self.options.render.split()]  # fmt: skip
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        if result.returncode != 0:
            sys.exit(f"measure-noise: {' '.join(command)}\n{result.stderr}")
        channels = read_exr(image)
        return luminance(channels), channels["samples.Y"], json.loads(result.stdout)


def least(reference: numpy.ndarray) -> float:
    """The luminance to which the errors of darker pixels are relative."""
    values = numpy.sort(reference.ravel())
    limit = values[len(values) - int(len(values) / 100) - 1]
    return 0.1 * numpy.minimum(reference, limit).mean()


def displayed(values: numpy.ndarray) -> numpy.ndarray:
    linear = numpy.clip(values, 0, 1)
    return numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def tile_percentile(squares: numpy.ndarray) -> float:
    height, width = (side // 8 * 8 for side in squares.shape)
    tiles = squares[:height, :width].reshape(height // 8, 8, width // 8, 8).mean((1, 3))
    return float(numpy.sqrt(numpy.percentile(tiles, 95)))


def measure(renders: Renders, scene: str, targets: list[float]) -> None:
    options = renders.options
    parts = [renders.render(scene, 1000 + i, options.reference // options.parts)[0] for i in range(options.parts)]
    reference = numpy.mean(parts, 0)
    scale = 1 / numpy.maximum(reference, least(reference)) ** 2
    own = numpy.var(parts, 0, ddof=1) / options.parts
    for target in targets:
        kept = [renders.render(scene, seed, options.spp, "--noise", f"{target:g}") for seed in range(1, options.seeds + 1)]
        squares, decided = 0.0, 0.0
        errors, weights = 0.0, 0.0
        for image, samples, _ in kept:
            error = ((image - reference) ** 2 - own) * scale
            is_decided = (samples > FEWEST) & (samples < options.spp)
            squares += error.mean() / len(kept)
            errors, weights = errors + error[is_decided].sum(), weights + is_decided.sum()
            decided += is_decided.mean() / len(kept)
        mean = sum(samples.mean() for _, samples, _ in kept) / len(kept)
        seconds = sum(statistics["render_seconds"] for _, _, statistics in kept) / len(kept)
        reached = sum(statistics["noise"]["reached"] for _, _, statistics in kept) / len(kept)
        most = sum((samples >= options.spp).mean() for _, samples, _ in kept) / len(kept)
        uniform = [renders.render(scene, seed, round(mean))[0] for seed in range(1, options.seeds + 1)]
        display = [numpy.mean([(displayed(image) - displayed(reference)) ** 2 for image in images], 0)
                   for images in ([image for image, _, _ in kept], uniform)]  # fmt: skip
        ratio = tile_percentile(display[1]) / tile_percentile(display[0])
        print(f"| {scene} | {target:g} | {math.sqrt(max(errors / max(weights, 1), 0)):.3f} | "
              f"{math.sqrt(max(squares, 0)):.3f} | {reached:.3f} | {100 * decided:.0f} % | {100 * most:.0f} % | "
              f"{mean:.0f} | {seconds:.1f} | {ratio:.2f} |", flush=True)  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/bin/alhazen", metavar="BIN")
    parser.add_argument("--targets", default="0.1", help="separated by commas")
    parser.add_argument("--only", default="", metavar="NAMES", help="scenes, separated by commas")
    parser.add_argument("--spp", type=int, default=1024, help="the most samples of a pixel")
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--reference", type=int, default=4096, help="samples per pixel of the reference")
    parser.add_argument("--parts", type=int, default=4, help="renders of which the reference is the mean")
    parser.add_argument("--pixels", type=int, default=160 * 90, help="about how many each image has")
    parser.add_argument("--render", default="", metavar="OPTIONS", help="more options of `alhazen render`")
    options = parser.parse_args()
    names = options.only.split(",") if options.only else list(SCENES)
    if unknown := set(names) - set(SCENES):
        sys.exit(f"measure-noise: no scene {', '.join(sorted(unknown))}; there are {', '.join(SCENES)}")
    print("| scene | target | error, decided | error, all | reached | decided | at most | mean spp | s | FLIP |")
    print("|---" * 10 + "|")
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            measure(Renders(options, pathlib.Path(folder)), name, [float(text) for text in options.targets.split(",")])


if __name__ == "__main__":
    main()
