#!/usr/bin/env python3
"""Error against time on one core, as a table and a plot (docs/results/quality.md).

  equal-time.py references --program BIN --scenes DIR --references DIR
      renders the references that are missing, by `path`; more --reference-seconds continue those that exist
  equal-time.py measure --program before=BIN --program after=BIN --scenes DIR --references DIR
      renders every scene for as many samples as fit into 5, 15 and 60 s of one core, and writes the page
  equal-time.py page
      writes the page again from the figures of the last measurement
  equal-time.py counters --program before=BIN --scenes DIR
      counts samples that are not used, by programs that were built with ALHAZEN_COUNTERS (docs/cpu.md)

DIR of --scenes holds scenes by other authors: pbrt/kitchen, gltf/ToyCar, hdr/chinese_garden_1k and so on. Those that
are not there are skipped, and said.

Seconds are processor seconds without reading the scene and building its BVH, so other programs on the machine count
little: the cost of a sample and of loading follow from two short renders, and the samples that fit are then rendered in
one run, for each scene by all programs and integrators in turn.

A reference is the mean of two halves with seeds of their own, so that relMSE(half, mean) estimates the variance of the
mean: the reference's own error. The error of an independent image against the reference is the sum of its own and of
the reference's, which is subtracted.
"""

import argparse
import array
import dataclasses
import datetime
import json
import math
import os
import pathlib
import platform
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/results/quality.md"
NEW_PAGE = """# Quality: error against time

<!-- equal-time.py measure -->
<!-- end -->

<!-- equal-time.py counters -->
<!-- end -->
"""
HALF_SEEDS = (1001, 1002)  # not among the seeds that are measured


@dataclasses.dataclass
class Scene:
    name: str
    file: str  # relative to --scenes, or to the repository if it starts with scenes/
    aspect: float = 16 / 9  # width / height
    options: tuple[str, ...] = ()
    environment: str = ""  # relative to --scenes

    def path(self, folder: pathlib.Path) -> pathlib.Path:
        return (ROOT if self.file.startswith("scenes/") else folder) / self.file

    def missing(self, folder: pathlib.Path) -> str:
        """The first of its files that does not exist, or nothing."""
        files = [self.path(folder)] + ([folder / self.environment] if self.environment else [])
        return next((str(file) for file in files if not file.exists()), "")

    def arguments(self, folder: pathlib.Path, pixels: int) -> list[str]:
        width, height = round(math.sqrt(pixels * self.aspect)), round(math.sqrt(pixels / self.aspect))
        environment = ["--environment", str(folder / self.environment)] if self.environment else []
        return [str(self.path(folder)), "--size", f"{width}x{height}", *environment, *self.options]


def asset(name: str, file: str, *options: str) -> Scene:
    garden = "hdr/chinese_garden_1k/chinese_garden_1k.hdr"
    return Scene(name, f"gltf/{name}/{file}", 16 / 9, ("--max-depth", "8", *options), garden)


SCENES = [
    Scene("kitchen", "pbrt/kitchen/scene-v4.pbrt"),
    Scene("veach-bidir", "pbrt/veach-bidir/scene-v4.pbrt", 1),
    Scene("staircase2", "pbrt/staircase2/staircase2.pbrt", 1),
    Scene("coffee", "pbrt/coffee/scene-v4.pbrt", 0.8),
    Scene("material-testball", "pbrt/material-testball/material-testball.pbrt"),
    Scene("spheres", "scenes/spheres.pbrt", 1),
    Scene("weekend", "scenes/weekend.pbrt"),
    Scene("mesh", "scenes/mesh.pbrt", 1.5),
    Scene("cornell-glass", "scenes/cornell-glass.pbrt", 1),
    Scene("window", "scenes/window.pbrt"),
    Scene("panel", "scenes/panel.pbrt"),
    asset("DamagedHelmet", "DamagedHelmet.glb"),
    asset("TransmissionTest", "TransmissionTest.glb", "--camera", "0"),
    asset("ToyCar", "ToyCar.gltf", "--camera", "0"),
]


@dataclasses.dataclass
class Method:
    label: str
    program: str
    integrator: str


@dataclasses.dataclass
class Cost:
    load: float  # processor seconds
    sample: float  # processor seconds of one sample of every pixel


def run(command: list[str]) -> tuple[str, float]:
    """Standard output and processor seconds of a command."""
    with tempfile.TemporaryFile("w+", encoding="utf-8") as errors, \
         subprocess.Popen(command, stdout=subprocess.PIPE, stderr=errors, text=True) as process:
        out = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        errors.seek(0)
        err = errors.read()
    if process.returncode != 0:
        sys.exit(f"equal-time: {' '.join(command)}\n{err.strip()}")
    return out, usage.ru_utime + usage.ru_stime


def render(program: str, arguments: list[str], samples: int, seed: int, image: pathlib.Path, *more: str):
    """Statistics of a render on one core, and its processor seconds."""
    out, seconds = run([program, "render", *arguments, "--backend", "serial", "--spp", str(samples), "--seed", str(seed),
                        "-o", str(image), "--stats=json", "--progress", "none", "-q", *more])  # fmt: skip
    return json.loads(out), seconds


def compare(program: str, image: pathlib.Path, reference: pathlib.Path) -> dict:
    """Metrics of `alhazen compare`."""
    return json.loads(run([program, "compare", "--json", str(image), str(reference)])[0])


def mean_image(a: pathlib.Path, b: pathlib.Path, mean: pathlib.Path) -> None:
    """Writes the mean of two PFM files of the same size: three lines of text, then single precision floats."""
    parts = [path.read_bytes().split(b"\n", 3) for path in (a, b)]
    values = [array.array("f", part[3]) for part in parts]
    sums = array.array("f", ((x + y) / 2 for x, y in zip(*values, strict=True)))
    temporary = mean.with_suffix(".tmp")
    temporary.write_bytes(b"\n".join([*parts[0][:3], sums.tobytes()]))
    temporary.replace(mean)


class References:
    """Folder of references. NAME-PIXELS.pfm is the mean of two halves NAME-PIXELS-SEED.pfm, each with a checkpoint;
    NAME-PIXELS.json says how many samples are wanted of both together, and whether they are all taken."""

    def __init__(self, options: argparse.Namespace):
        self.options = options
        self.folder = pathlib.Path(options.references)
        self.folder.mkdir(parents=True, exist_ok=True)

    def file(self, scene: Scene, ending: str) -> pathlib.Path:
        return self.folder / f"{scene.name}-{self.options.pixels}{ending}"

    def image(self, scene: Scene) -> pathlib.Path:
        return self.file(scene, ".pfm")

    def halves(self, scene: Scene) -> list[pathlib.Path]:
        return [self.file(scene, f"-{seed}.pfm") for seed in HALF_SEEDS]

    def plan(self, scene: Scene) -> dict:
        path = self.file(scene, ".json")
        return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {"asked": 0, "complete": False}

    def keep_plan(self, scene: Scene, plan: dict) -> None:
        self.file(scene, ".json").write_text(json.dumps(plan), encoding="utf-8")

    def make(self, scene: Scene, program: str) -> None:
        plan = self.plan(scene)
        if plan["complete"] and plan["asked"] >= self.options.reference_seconds:
            return
        arguments = [*scene.arguments(pathlib.Path(self.options.scenes), self.options.pixels), "--integrator", "path"]
        if plan["asked"] < self.options.reference_seconds:  # else a larger one was interrupted
            cost = measure_cost(program, arguments, self.halves(scene)[0])
            # Whole blocks of 4 samples, which a checkpoint holds to the end.
            blocks = max(1, round(self.options.reference_seconds / cost.sample / 8))
            plan = {"asked": self.options.reference_seconds, "samples": 2 * 4 * blocks}
        self.keep_plan(scene, plan | {"complete": False})
        for half, seed in zip(self.halves(scene), HALF_SEEDS):
            state = half.with_suffix(".state")
            resume = ["--resume"] if state.exists() else []
            render(program, arguments, plan["samples"] // 2, seed, half, "--checkpoint", f"{state},30", *resume)
        mean_image(*self.halves(scene), self.image(scene))
        self.keep_plan(scene, plan | {"complete": True})
        error = compare(program, self.halves(scene)[0], self.image(scene))["relmse"]
        print(f"{scene.name}: {plan['samples']} samples, {plan['asked']:g} s, own relMSE {error:.2g}", flush=True)

    def facts(self, scene: Scene, program: str) -> dict | None:
        """Samples and error of a complete reference; none if there is no such reference."""
        plan = self.plan(scene)
        if not plan["complete"]:
            return None
        error = compare(program, self.halves(scene)[0], self.image(scene))
        return {"samples": plan["samples"], "relmse": error["relmse"], "trimmed": error["relmse_trimmed"]}


def measure_cost(program: str, arguments: list[str], image: pathlib.Path, seconds: float = 0.7) -> Cost:
    """From a render of 4 samples and one that takes longer by `seconds` or more."""
    few, many = 4, 16
    _, first = render(program, arguments, few, 1, image)
    while True:
        _, second = render(program, arguments, many, 1, image)
        if second - first >= seconds:
            sample = (second - first) / (many - few)
            return Cost(max(0.0, first - few * sample), sample)
        many *= 2  # not more: loading takes a little more one time than another


class Measurement:
    def __init__(self, options: argparse.Namespace, methods: list[Method]):
        self.options = options
        self.methods = methods
        self.references = References(options)
        self.image = self.references.folder / "measured.pfm"
        self.rows: list[dict] = []

    def scene(self, scene: Scene) -> None:
        facts = self.references.facts(scene, self.options.compare)
        if not facts:
            print(f"{scene.name}: skipped, its reference is not complete: equal-time.py references", flush=True)
            return
        base = scene.arguments(pathlib.Path(self.options.scenes), self.options.pixels)
        arguments = [[*base, "--integrator", method.integrator, *self.options.render] for method in self.methods]
        costs = [measure_cost(method.program, of, self.image) for method, of in zip(self.methods, arguments)]
        for seconds in self.options.seconds:
            for seed in range(1, self.options.seeds + 1):
                for method, cost, of in zip(self.methods, costs, arguments):
                    self.measure(scene, facts, method, of, cost, seconds, seed)

    def measure(self, scene, facts, method, arguments, cost, seconds, seed) -> None:
        samples = max(1, round(seconds / cost.sample))
        _, spent = render(method.program, arguments, samples, seed, self.image)
        error = compare(self.options.compare, self.image, self.references.image(scene))
        row = {"scene": scene.name, "method": method.label, "asked": seconds, "seed": seed, "samples": samples,
               "seconds": max(spent - cost.load, 1e-3), "relmse": own_error(error["relmse"], facts["relmse"]),
               "trimmed": own_error(error["relmse_trimmed"], facts["trimmed"]),
               "flip": error["flip"], "mean": error["mean_a"] / error["mean_b"], "reference": facts}  # fmt: skip
        self.rows.append(row)
        print(f"{scene.name}, {method.label}, {seconds} s: {samples} samples in {row['seconds']:.2f} s, "
              f"relMSE {row['relmse']:.4g}, trimmed {row['trimmed']:.4g}, FLIP {row['flip']:.3f}", flush=True)


def own_error(measured: float, of_reference: float) -> float:
    """The error of an image without that of the reference, of which a tenth is left at least: both are estimates."""
    return max(measured - of_reference, measured / 10)


def machine() -> str:
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def mean_of_seeds(rows: list[dict]) -> list[dict]:
    """One row for each scene, method and time: means over the seeds."""
    groups: dict[tuple, list[dict]] = {}
    for row in rows:
        groups.setdefault((row["scene"], row["method"], row["asked"]), []).append(row)
    means = []
    for group in groups.values():
        mean = dict(group[0])
        for key in ("samples", "seconds", "relmse", "trimmed", "flip", "mean"):
            mean[key] = sum(row[key] for row in group) / len(group)
        means.append(mean)
    return means


def efficiency(row: dict, error: str) -> float:
    return 1 / (row[error] * row["seconds"])


def figure(row: dict, error: str) -> str:
    """An error, with a star where what was subtracted is not small."""
    return f"{row[error]:.3g}{'*' if row['reference'][error] > row[error] / 3 else ''}"


def tables(rows: list[dict]) -> str:
    methods = list(dict.fromkeys(row["method"] for row in rows))
    first = {(row["scene"], row["asked"]): row for row in rows if row["method"] == methods[0]}
    lines = []
    if len(methods) > 1:
        lines += [f"Efficiency, 1 / (relMSE x seconds), as a multiple of `{methods[0]}`: geometric mean over the times, "
                  "of all pixels and trimmed.", "",
                  "| scene | " + " | ".join(methods[1:]) + " |", "|---" * len(methods) + "|"]  # fmt: skip
        for scene in dict.fromkeys(row["scene"] for row in rows):
            cells = []
            for method in methods[1:]:
                mine = [row for row in rows if row["scene"] == scene and row["method"] == method]
                if not mine:
                    cells.append("")
                    continue
                ratios = [math.exp(sum(math.log(efficiency(row, error) / efficiency(first[scene, row["asked"]], error))
                                       for row in mine) / len(mine)) for error in ("relmse", "trimmed")]  # fmt: skip
                cells.append(f"{ratios[0]:.2f}, trimmed {ratios[1]:.2f}")
            lines.append(f"| {scene} | " + " | ".join(cells) + " |")
        lines.append("")
    lines += ["| scene | program | s | samples | relMSE | trimmed | FLIP | mean / reference | 1/(relMSE s) | trimmed |",
              "|---" * 10 + "|"]  # fmt: skip
    for row in rows:
        lines.append(f"| {row['scene']} | {row['method']} | {row['seconds']:.1f} | {row['samples']:.0f} | "
                     f"{figure(row, 'relmse')} | {figure(row, 'trimmed')} | {row['flip']:.3f} | {row['mean']:.3f} | "
                     f"{efficiency(row, 'relmse'):.3g} | {efficiency(row, 'trimmed'):.3g} |")  # fmt: skip
    lines += ["", "| reference | samples | its own relMSE | trimmed |", "|---|---|---|---|"]
    for scene, facts in {row["scene"]: row["reference"] for row in rows}.items():
        lines.append(f"| {scene} | {facts['samples']} | {facts['relmse']:.2g} | "
                     f"{facts['trimmed']:.2g} |")
    return "\n".join(lines)


def plot(rows: list[dict], path: pathlib.Path) -> None:
    import matplotlib  # only the plot needs it

    matplotlib.use("Agg")
    from matplotlib import pyplot

    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    methods = list(dict.fromkeys(row["method"] for row in rows))
    columns = 4 if len(scenes) > 4 else len(scenes)
    lines = math.ceil(len(scenes) / columns)
    fig, axes = pyplot.subplots(lines, columns, figsize=(3 * columns, 2.5 * lines), squeeze=False)
    for axis in axes.flat[len(scenes):]:
        axis.axis("off")
    for axis, scene in zip(axes.flat, scenes):
        for index, method in enumerate(methods):
            mine = sorted((row for row in rows if row["scene"] == scene and row["method"] == method),
                          key=lambda row: row["seconds"])  # fmt: skip
            times = [row["seconds"] for row in mine]
            axis.loglog(times, [row["relmse"] for row in mine], "o-", color=f"C{index}", markersize=3, label=method)
            axis.loglog(times, [row["trimmed"] for row in mine], "o:", color=f"C{index}", markersize=3, fillstyle="none")
        of_scene = [row for row in rows if row["scene"] == scene]
        errors = [row[error] for row in of_scene for error in ("relmse", "trimmed")]
        axis.set_xlim(min(row["seconds"] for row in rows) / 1.5, max(row["seconds"] for row in rows) * 1.5)
        axis.set_ylim(10 ** math.floor(math.log10(min(errors))), 10 ** math.ceil(math.log10(max(errors))))
        axis.set_title(scene, fontsize=9)
        axis.tick_params(labelsize=7)
        axis.tick_params(which="minor", labelbottom=False, labelleft=False)
        times = sorted({row["asked"] for row in rows})
        axis.set_xticks(times, [f"{time:g}" for time in times])
        axis.grid(True, which="both", linewidth=0.3)
    for axis in axes[:, 0]:
        axis.set_ylabel("relMSE", fontsize=8)
    for axis in axes[-1]:
        axis.set_xlabel("seconds of one core", fontsize=8)
    fig.legend(*axes.flat[0].get_legend_handles_labels(), loc="lower right", fontsize=8)
    fig.tight_layout()
    fig.savefig(path, dpi=110)


def write_block(page: pathlib.Path, task: str, text: str) -> None:
    """Replaces what the task wrote into the page before; what stands around it is kept."""
    begin, end = f"<!-- equal-time.py {task} -->", "<!-- end -->"
    before, rest = (page.read_text(encoding="utf-8") if page.exists() else NEW_PAGE).split(begin, 1)
    page.write_text(f"{before}{begin}\n\n{text}\n\n{end}{rest.split(end, 1)[1]}", encoding="utf-8")


def write_measurement(options: argparse.Namespace) -> None:
    data = json.loads(pathlib.Path(options.json).read_text(encoding="utf-8"))
    page = pathlib.Path(options.page)
    rows = mean_of_seeds(data["rows"])
    figure = page.with_suffix(".png")
    plot(rows, figure)
    text = (f"{data['machine']}, {data['date']}, {data['pixels']} pixels, {data['seeds']} "
            f"{'seed' if data['seeds'] == 1 else 'seeds'}.\n\n    {data['command']}\n\n{tables(rows)}\n\n"
            f"![Error against seconds of one core, hollow: trimmed]({figure.name})")  # fmt: skip
    write_block(page, "measure", text)


def percentage(part: int, whole: int) -> str:
    return f"{100 * part / whole:.1f} %" if whole else ""


def count(options: argparse.Namespace, scenes: list[Scene]) -> None:
    """Writes which samples of lights and BSDFs each program does not use, from a few samples of every pixel."""
    lines = ["| scene | program | light samples | unlit or black | shadow rays blocked | BSDF samples | black | "
             "ended by roulette |", "|---" * 8 + "|"]  # fmt: skip
    for scene in scenes:
        for method in methods_of(options):
            arguments = scene.arguments(pathlib.Path(options.scenes), options.pixels // 4)
            image = pathlib.Path(options.references) / "counted.pfm"
            image.parent.mkdir(parents=True, exist_ok=True)
            statistics, _ = render(method.program, arguments, 4, 1, image, *options.render)
            if "counters" not in statistics:
                sys.exit(f"equal-time: {method.program} does not count: build it with -DALHAZEN_COUNTERS=ON")
            lights, bsdfs = (sum_of(statistics["counters"][key]) for key in ("light_samples_by_light", "bsdf_samples"))
            lines.append(
                f"| {scene.name} | {method.label} | {lights.get('drawn', 0)} | "
                f"{percentage(lights.get('unlit', 0) + lights.get('black', 0), lights.get('drawn', 0))} | "
                f"{percentage(lights.get('blocked', 0), lights.get('shadow_rays', 0))} | {bsdfs.get('drawn', 0)} | "
                f"{percentage(bsdfs.get('black', 0), bsdfs.get('drawn', 0))} | "
                f"{percentage(bsdfs.get('roulette', 0), bsdfs.get('drawn', 0))} |"
            )
            print(lines[-1], flush=True)
    write_block(pathlib.Path(options.page), "counters", "\n".join(lines))


def sum_of(counts: dict[str, dict[str, int]]) -> dict[str, int]:
    """Counts of all kinds together."""
    keys = {key for of_kind in counts.values() for key in of_kind}
    return {key: sum(of_kind[key] for of_kind in counts.values()) for key in keys}


def methods_of(options: argparse.Namespace) -> list[Method]:
    methods = []
    for text in options.program:
        label, separator, path = text.partition("=")
        if not separator:
            label, path = "alhazen", text
        for integrator in options.integrator:
            name = label if integrator == "path" else f"{label}, {integrator}"
            methods.append(Method(name, path, integrator))
    return methods


def measure(options: argparse.Namespace, scenes: list[Scene]) -> None:
    measurement = Measurement(options, methods_of(options))
    shown = ["scripts/equal-time.py measure", *(f"--program {method.label}=BIN" for method in measurement.methods
                                               if method.integrator == options.integrator[0]),
             "--scenes DIR --references DIR", "--seconds " + ",".join(f"{s:g}" for s in options.seconds)]  # fmt: skip
    if options.integrator != ["path"]:
        shown.append("--integrator " + ",".join(options.integrator))
    for scene in scenes:
        measurement.scene(scene)
        data = {"date": datetime.date.today().isoformat(), "machine": machine() + ", one core", "rows": measurement.rows,
                "pixels": options.pixels, "seeds": options.seeds, "command": " ".join(shown)}  # fmt: skip
        pathlib.Path(options.json).write_text(json.dumps(data, indent=1), encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("task", choices=["references", "measure", "page", "counters"])
    parser.add_argument("--program", action="append", metavar="[LABEL=]BIN", help="may be given more than once")
    parser.add_argument("--compare", metavar="BIN", help="the program that compares images; default: the last --program")
    parser.add_argument("--scenes", default="", metavar="DIR", help="scenes by other authors")
    parser.add_argument("--references", default="build/references", metavar="DIR")
    parser.add_argument("--reference-seconds", type=float, default=600, help="of one core, for each scene")
    parser.add_argument("--seconds", default="5,15,60", help="of one core")
    parser.add_argument("--integrator", default="path", help="path, iterative, or both separated by a comma")
    parser.add_argument("--seeds", type=int, default=1, help="independent images, of which errors are the mean")
    parser.add_argument("--only", default="", metavar="NAMES", help="scenes, separated by commas")
    parser.add_argument("--pixels", type=int, default=320 * 180, help="about how many each image has")
    parser.add_argument("--render", default="", metavar="OPTIONS", help="more options of `alhazen render`")
    parser.add_argument("--json", default="build/quality.json", help="the figures")
    parser.add_argument("--page", default=str(PAGE), help="the page, and beside it the plot")
    options = parser.parse_args()
    options.program = options.program or ["build/release/bin/alhazen"]
    options.compare = options.compare or options.program[-1].split("=", 1)[-1]
    options.seconds = [float(text) for text in options.seconds.split(",")]
    options.integrator, options.render = options.integrator.split(","), options.render.split()
    only = [name for name in options.only.split(",") if name]
    if unknown := set(only) - {scene.name for scene in SCENES}:
        sys.exit(f"equal-time: no scene {', '.join(sorted(unknown))}; there are " + ", ".join(s.name for s in SCENES))
    scenes = [scene for scene in SCENES if not only or scene.name in only]
    for scene in list(scenes):
        if options.task != "page" and (missing := scene.missing(pathlib.Path(options.scenes))):
            print(f"{scene.name}: skipped, {missing} does not exist", flush=True)
            scenes.remove(scene)
    if options.task == "references":
        references = References(options)
        for scene in scenes:
            references.make(scene, methods_of(options)[0].program)
        return
    if options.task == "counters":
        count(options, scenes)
        return
    if options.task == "measure":
        measure(options, scenes)
    write_measurement(options)


if __name__ == "__main__":
    main()
