#!/usr/bin/env python3
"""How well a noise target is met (docs/noise.md): target, measured error, samples and time, and FLIP at equal samples.

  measure-noise.py [--program BIN] [--targets "0.1 0.02,display"] [--only NAMES]
  measure-noise.py --oracle 128 [--program BIN] [--only NAMES]

Every scene of the repository is rendered with each target by several seeds, and compared with a reference: the mean of
uniform renders by other seeds, together `--reference` samples per pixel. The error of a pixel is that of its luminance,
relative to the luminance of the reference or, where that is darker, to a tenth of the mean of the image without its
brightest hundredth, as in the estimate; of a target of what is displayed, that of the sRGB value that is shown. Its mean square over pixels and seeds has the reference's own variance
subtracted, which the spread of the reference's parts gives. Pixels that got the fewest samples or the most are left out
of `decided`: there the target decided nothing.

FLIP is the 95th percentile, over pixels, of the FLIP error of uniform renders that take as many samples as the others
in the mean, over that of the others.

`--oracle N` asks instead how much FLIP could gain at all by sending N samples per pixel, in the mean, to where the
noise is. The noise is simulated: normally distributed, with the variance of the samples of each pixel of the reference.
So the number of samples is chosen by a variance that is known, which no estimate can be better than: in proportion to
it ("equal errors", as a target does), and to its 0.7th power, each as displayed and averaged over 3 x 3 pixels or over
25 x 25, from 16 to --spp. Needs numpy.
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

    def flip(self, image: dict[str, numpy.ndarray], reference: dict[str, numpy.ndarray]) -> numpy.ndarray:
        """The FLIP error of every pixel."""
        paths = [self.folder / name for name in ("a.pfm", "b.pfm", "flip.pfm")]
        write_pfm(paths[0], image)
        write_pfm(paths[1], reference)
        subprocess.run([self.options.program, "compare", paths[0], paths[1], "--diff", paths[2]],
                       check=True, capture_output=True)  # fmt: skip
        # The red of the colour map of src/images/display/colour_map.cpp, which rises up to 7/8.
        red = 255 * displayed(read_pfm(paths[2]))
        return numpy.interp(red, [0, 28, 79, 129, 181, 229, 251, 254], numpy.arange(8) / 8)

    def render(self, scene: str, seed: int, samples: int, *more: str) -> tuple[dict[str, numpy.ndarray], dict]:
        """Channels of the image, and statistics."""
        file, aspect = SCENES[scene]
        size = f"{round(math.sqrt(self.options.pixels * aspect))}x{round(math.sqrt(self.options.pixels / aspect))}"
        image = self.folder / "image.exr"
        command = [self.options.program, "render", str(ROOT / "scenes" / file), "--size", size, "--seed", str(seed),
                   "--spp", str(samples), "-o", str(image), "--exr-type", "float", "--aov", "samples", "--stats=json",
                   "--exposure", "0", "-q", "--progress", "none", *more, *self.options.render.split()]  # fmt: skip
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        if result.returncode != 0:
            sys.exit(f"measure-noise: {' '.join(command)}\n{result.stderr}")
        channels = read_exr(image)
        return channels, json.loads(result.stdout)


def least(reference: numpy.ndarray) -> float:
    """The luminance to which the errors of darker pixels are relative."""
    values = numpy.sort(reference.ravel())
    limit = values[len(values) - int(len(values) / 100) - 1]
    return 0.1 * numpy.minimum(reference, limit).mean()


def displayed(values: numpy.ndarray) -> numpy.ndarray:
    linear = numpy.clip(values, 0, 1)
    return numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def write_pfm(path: pathlib.Path, image: dict[str, numpy.ndarray]) -> None:
    height, width = image["R"].shape
    pixels = numpy.stack([image[channel] for channel in LUMINANCE], -1)[::-1].astype("<f4")
    path.write_bytes(f"PF\n{width} {height}\n-1\n".encode() + pixels.tobytes())


def read_pfm(path: pathlib.Path) -> numpy.ndarray:
    kind, size, _, values = path.read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    return numpy.frombuffer(values, "<f4").reshape(height, width, -1 if kind == b"PF" else 1)[..., 0]


def box_means(values: numpy.ndarray, radius: int) -> numpy.ndarray:
    padded = numpy.pad(values, radius, mode="edge")
    windows = numpy.lib.stride_tricks.sliding_window_view(padded, (2 * radius + 1, 2 * radius + 1))
    return windows.mean((2, 3))


def allotted(weights: numpy.ndarray, mean: float, most: int) -> numpy.ndarray:
    """Samples in proportion to `weights`, from FEWEST to `most`, that have this mean."""
    low, high = -60.0, 60.0
    for _ in range(100):
        middle = (low + high) / 2
        too_many = numpy.clip(weights * math.exp(middle), FEWEST, most).mean() > mean
        low, high = (low, middle) if too_many else (middle, high)
    return numpy.clip(weights * math.exp(low), FEWEST, most)


def simulate(renders: Renders, scene: str) -> None:
    options, mean = renders.options, renders.options.oracle
    parts = [renders.render(scene, 1000 + i, options.reference // options.parts, "--aov", "variance")[0]
             for i in range(options.parts)]  # fmt: skip
    whole = {channel: numpy.mean([part[channel] for part in parts], 0) for channel in LUMINANCE}
    reference = luminance(whole)
    deviation = numpy.sqrt(box_means(numpy.mean([part["variance.Y"] for part in parts], 0), 1))
    error = deviation / math.sqrt(mean)
    shown = ((displayed(reference + error) - displayed(numpy.maximum(reference - error, 0))) / 2) ** 2
    random = numpy.random.default_rng(1)

    def flip(samples: numpy.ndarray) -> float:
        images = []
        for _ in range(options.seeds):
            noise = random.standard_normal(reference.shape) * deviation / numpy.sqrt(samples)
            factor = 1 + noise / numpy.maximum(reference, 1e-9)
            images.append(renders.flip({c: numpy.maximum(whole[c] * factor, 0) for c in LUMINANCE}, whole))
        return float(numpy.percentile(images, 95))

    uniform = flip(numpy.full(reference.shape, float(mean)))
    weights = [box_means(shown, 1), box_means(shown, 12), box_means(shown, 1) ** 0.7]
    gains = [uniform / flip(allotted(weight + 1e-12, mean, options.spp)) for weight in weights]
    print(f"| {scene} | {mean} | {uniform:.3f} | {gains[0]:.2f} | {gains[1]:.2f} | {gains[2]:.2f} |", flush=True)


def measure(renders: Renders, scene: str, targets: list[str]) -> None:
    options = renders.options
    parts = [renders.render(scene, 1000 + i, options.reference // options.parts)[0] for i in range(options.parts)]
    whole = {channel: numpy.mean([part[channel] for part in parts], 0) for channel in LUMINANCE}
    reference = luminance(whole)
    scale = 1 / numpy.maximum(reference, least(reference))
    for target in targets:
        of = displayed if target.endswith(",display") else lambda values: values * scale
        own = numpy.var([of(luminance(part)) for part in parts], 0, ddof=1) / options.parts
        kept = [renders.render(scene, seed, options.spp, "--noise", target) for seed in range(1, options.seeds + 1)]
        all_samples = [image["samples.Y"] for image, _ in kept]
        squares = [(of(luminance(image)) - of(reference)) ** 2 - own for image, _ in kept]
        is_decided = [(samples > FEWEST) & (samples < options.spp) for samples in all_samples]
        errors = sum(square[here].sum() for square, here in zip(squares, is_decided)) / max(1, numpy.sum(is_decided))
        mean = float(numpy.mean(all_samples))
        seconds = numpy.mean([statistics["render_seconds"] for _, statistics in kept])
        reached = numpy.mean([statistics["noise"]["reached"] for _, statistics in kept])
        uniform = [renders.render(scene, seed, round(mean)) for seed in range(1, options.seeds + 1)]
        flips = [numpy.percentile([renders.flip(image, whole) for image, _ in images], 95) for images in (kept, uniform)]
        print(f"| {scene} | {target} | {math.sqrt(max(errors, 0)):.3f} | {math.sqrt(max(numpy.mean(squares), 0)):.3f} | "
              f"{reached:.3f} | {100 * numpy.mean(is_decided):.0f} % | "
              f"{100 * numpy.mean([samples >= options.spp for samples in all_samples]):.0f} % | {mean:.0f} | "
              f"{seconds:.1f} | {flips[0]:.3f} | {flips[1] / flips[0]:.2f} |", flush=True)  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/bin/alhazen", metavar="BIN")
    parser.add_argument("--targets", default="0.1 0.02,display", help="values of --noise, separated by spaces")
    parser.add_argument("--only", default="", metavar="NAMES", help="scenes, separated by commas")
    parser.add_argument("--spp", type=int, default=1024, help="the most samples of a pixel")
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--reference", type=int, default=4096, help="samples per pixel of the reference")
    parser.add_argument("--parts", type=int, default=4, help="renders of which the reference is the mean")
    parser.add_argument("--pixels", type=int, default=160 * 90, help="about how many each image has")
    parser.add_argument("--oracle", type=int, metavar="N", help="simulate the best distribution of N samples per pixel")
    parser.add_argument("--render", default="", metavar="OPTIONS", help="more options of `alhazen render`")
    options = parser.parse_args()
    names = options.only.split(",") if options.only else list(SCENES)
    if unknown := set(names) - set(SCENES):
        sys.exit(f"measure-noise: no scene {', '.join(sorted(unknown))}; there are {', '.join(SCENES)}")
    if options.oracle:
        print("| scene | mean spp | uniform FLIP | equal errors | over 25 x 25 | to the power 0.7 |")
        print("|---" * 6 + "|")
        with tempfile.TemporaryDirectory() as folder:
            for name in names:
                simulate(Renders(options, pathlib.Path(folder)), name)
        return
    print("| scene | target | error, decided | error, all | reached | decided | at most | mean spp | s | FLIP | uniform / it |")
    print("|---" * 11 + "|")
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            measure(Renders(options, pathlib.Path(folder)), name, options.targets.split())


if __name__ == "__main__":
    main()
