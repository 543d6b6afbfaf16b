#!/usr/bin/env python3
"""Error of the samplers `sobol` and `zsobol` before and after a blur (docs/results/quality.md).

  blue-noise.py --program BIN [--samples 4,16] [--picture FILE]

Every scene is rendered by both samplers, and by 2,048 samples of another seed as a reference. Printed is the relMSE,
mean((image - reference)^2 / (reference^2 + 0.01)), of the images, and of images and reference blurred by a Gaussian
with a standard deviation of one pixel, as means over four seeds. The picture shows an enlarged part of the first scene.
"""

import argparse
import pathlib
import subprocess
import tempfile

import numpy

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = {"cornell": "192x192", "spheres": "192x192", "mesh": "240x160", "panel": "256x144"}


def render(program: str, scene: str, samples: int, sampler: str, seed: int, folder: str) -> numpy.ndarray:
    """Linear RGB, rows from the bottom."""
    image = pathlib.Path(folder) / "image.pfm"
    subprocess.run([program, "render", str(ROOT / f"scenes/{scene}.pbrt"), "--size", SCENES[scene], "--spp", str(samples),
                    "--sampler", sampler, "--seed", str(seed), "-q", "-o", str(image)], check=True)  # fmt: skip
    _, size, _, pixels = image.read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    return numpy.frombuffer(pixels, "<f4").reshape(height, width, 3).astype(float)


def blurred(image: numpy.ndarray) -> numpy.ndarray:
    weights = numpy.exp(-0.5 * numpy.arange(-4, 5) ** 2)
    weights /= weights.sum()
    for axis in (0, 1):
        image = numpy.apply_along_axis(lambda line: numpy.convolve(line, weights, "same"), axis, image)
    return image[4:-4, 4:-4]


def relmse(image: numpy.ndarray, reference: numpy.ndarray) -> float:
    return float(((image - reference) ** 2 / (reference**2 + 0.01)).mean())


def show(images: list[tuple[str, numpy.ndarray]], path: str) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    fig, axes = pyplot.subplots(1, len(images), figsize=(4 * len(images), 4.3))
    for axis, (title, image) in zip(axes, images):
        part = image[::-1][40:136, 50:146]
        axis.imshow(numpy.clip(part, 0, 1) ** (1 / 2.2), interpolation="nearest")
        axis.set_title(title)
        axis.axis("off")
    fig.tight_layout()
    fig.savefig(path, dpi=80)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build/release/bin/alhazen"))
    parser.add_argument("--samples", default="4,16")
    parser.add_argument("--picture", default="", metavar="FILE")
    options = parser.parse_args()
    print("| scene | samples | sobol | zsobol | blurred: sobol | zsobol | ratio |\n|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for scene in SCENES:
            reference = render(options.program, scene, 2048, "sobol", 99, folder)
            smooth = blurred(reference)
            for samples in map(int, options.samples.split(",")):
                errors = {}
                shown = [("reference", reference)]
                for sampler in ("sobol", "zsobol"):
                    images = [render(options.program, scene, samples, sampler, seed, folder) for seed in range(1, 5)]
                    errors[sampler] = (numpy.mean([relmse(image, reference) for image in images]),
                                       numpy.mean([relmse(blurred(image), smooth) for image in images]))  # fmt: skip
                    shown.append((f"{sampler}, {samples} samples", images[0]))
                sobol, zsobol = errors["sobol"], errors["zsobol"]
                print(f"| {scene} | {samples} | {sobol[0]:.3g} | {zsobol[0]:.3g} | {sobol[1]:.3g} | {zsobol[1]:.3g} | "
                      f"{zsobol[1] / sobol[1]:.2f} |", flush=True)  # fmt: skip
                if options.picture and scene == "cornell" and samples == int(options.samples.split(",")[0]):
                    show(shown, options.picture)


if __name__ == "__main__":
    main()
