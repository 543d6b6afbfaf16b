#!/usr/bin/env python3
"""Renders scenes with a program built with sanitizers, at a tiny size and with every backend, and reports problems.

  cmake --preset debug && cmake --build --preset debug --target alhazen_cli
  scripts/sanitize-scenes.py FOLDER... [--binary build/debug/bin/alhazen] [--size 16] [--spp 1] [--seconds 5]
                             [--ways TEXT...] [--mutations N] [--seed 1] [--timeout 300] [--only TEXT] [--keep DIR]
                             [--nan] [--memcheck]

Scenes are the .pbrt, .gltf, .glb and .ply files (and the same with .gz) below FOLDER, or a file itself; images (.exr,
.hdr, .pfm, .png) below a folder without scenes are rendered as the environment of a sphere. A finding is output
of a sanitizer, an exit code that is neither 0 nor 2, or a run that does not end within --timeout. Each is printed with
the command that reproduces it, and makes the exit code 1.

--mutations N renders, of every scene up to 1 MB, N copies in which a number was replaced by an odd one, bytes were
changed, or the end is missing; by one way each. --keep DIR keeps the copies that were findings. --nan counts the warning
that samples were infinite or NaN as a finding too, which with odd numbers it need not be. --memcheck runs a release
build (--binary build/release/bin/alhazen) under valgrind instead: branches of a kernel on uninitialised values, which
the sanitizers of GCC do not find, are findings.
"""

import argparse
import os
import pathlib
import random
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = (".pbrt", ".gltf", ".glb", ".ply", ".pbrt.gz", ".ply.gz")
IMAGES = (".exr", ".hdr", ".pfm", ".png")
WAYS = {
    "serial float": "--backend serial",
    "serial double": "--backend serial --precision double --integrator iterative",
    "openmp float": "--backend openmp --threads 2 --strategy reduction --aov albedo,normal,depth,variance",
    "embree float": "--backend embree --threads 2",
    "host float": "--backend cuda --device host",
    "host double": "--backend cuda --device host --strategy wavefront --precision double",
}
ODD_NUMBERS = ["0", "-1", "1", "0.5", "3", "255", "1e-30", "1e-8", "1e4", "-1e4", "1e9", "1e18", "1e30", "-1e30", "3e38", "1e308",
               "-1e308", "1e400", "nan", "2147483647", "-2147483648", "4294967296"]
# Numbers that are values, not parts of names or of data.
NUMBER = re.compile(rb"(?<=[\s\[,:])-?\d+\.?\d*(?:[eE][-+]?\d+)?(?=[\s\],}])")
# Of valgrind, whose reports of string functions of the standard library are false ones.
KERNEL_ERROR = re.compile(r"uninitialised[^\n]*\n[^\n]*alhazen::impl::(baseline|avx2|avx512)::")
MAX_MUTATED = 1 << 20
SPHERE = 'WorldBegin\nMaterial "conductor" "float roughness" 0.2\nShape "sphere"\n'


def scenes_below(folder):
    if folder.is_file():
        return [folder]
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    scenes = [path for path in files if path.name.lower().endswith(SCENES)]
    return scenes or [path for path in files if path.name.lower().endswith(IMAGES)]


def ways_of(binary, wanted):
    """The settings that this build supports, or those whose name contains one of the given texts."""
    listing = subprocess.run([binary, "devices"], capture_output=True, text=True, check=False).stdout
    names = [name for name in WAYS if not wanted or any(text in name for text in wanted)]
    return [name for name in names if not (name.startswith("embree") and "libembree-dev" in listing)]


class Runner:
    def __init__(self, options, folder):
        self.options = options
        self.folder = folder
        self.logs = folder / "logs"
        self.logs.mkdir()
        self.environment = dict(os.environ, ALHAZEN_TUNED="")
        # To files, since a program may close its own streams; without symbols the report could not be read.
        common = f"log_path={self.logs}/log:print_stacktrace=1:symbolize=1"
        self.environment["ASAN_OPTIONS"] = common + ":allocator_may_return_null=0:detect_stack_use_after_return=1"
        self.environment["UBSAN_OPTIONS"] = common
        if options.memcheck:
            self.environment["OMP_NUM_THREADS"] = "1"
        self.runs = 0
        self.refused = 0
        self.findings = 0

    def command(self, scene, way):
        command = [str(self.options.binary), "render", str(scene), "-q", "-o", str(self.folder / "image.exr"), "-o",
                   str(self.folder / "image.png"), "--size", f"{self.options.size}x{self.options.size}", "--spp",
                   str(self.options.spp), "--time-limit", str(self.options.seconds), *shlex.split(WAYS[way])]
        if scene.name.lower().endswith(IMAGES):
            sphere = self.folder / "sphere.pbrt"
            sphere.write_text(SPHERE)
            command[2:3] = [str(sphere), "--environment", str(scene)]
        if self.options.memcheck:
            command[:0] = ["valgrind", "--quiet", "--error-limit=no", f"--log-file={self.logs}/log", "--num-callers=6"]
        return command

    def render(self, scene, way):
        """Returns whether the scene was fine with these settings; prints any problem."""
        command = self.command(scene, way)
        self.runs += 1
        try:
            done = subprocess.run(command, capture_output=True, timeout=self.options.timeout, env=self.environment,
                                  check=False)
            code, output = done.returncode, (done.stdout + done.stderr).decode("utf-8", "replace")
        except subprocess.TimeoutExpired:
            code, output = None, ""
        reports = []
        for log in sorted(self.logs.iterdir()):
            reports.append(log.read_text("utf-8", "replace"))
            log.unlink()
        if self.options.memcheck:
            reports = [text for text in reports if KERNEL_ERROR.search(text)]
        self.refused += code == 2
        problem = ("a sanitizer's report" if reports else f"no end within {self.options.timeout} s" if code is None else
                   f"exit code {code}" if code not in (0, 2) else "no message" if code == 2 and not output.strip() else
                   "samples that are NaN" if self.options.nan and "infinite or NaN" in output else "")
        if not problem:
            return True
        self.findings += 1
        print(f"\nFINDING: {problem}: {scene} ({way})\n  {shlex.join(command)}")
        for text in reports or [output]:
            print("    " + "\n    ".join(text.splitlines()[:25]))
        sys.stdout.flush()
        return False


def mutated(data, numbers):
    """A copy of a file with a few changes. `numbers` generates random numbers."""
    places = [match.span() for match in NUMBER.finditer(data)]
    if places and numbers.random() < 0.8:
        for _ in range(numbers.choice([1, 1, 1, 2, 3])):
            begin, end = numbers.choice(places)
            data = data[:begin] + numbers.choice(ODD_NUMBERS).encode() + data[end:]
            places = [(b, e) for b, e in places if e <= begin]
            if not places:
                break
        return data
    if numbers.random() < 0.5 and len(data) > 1:
        return data[:numbers.randrange(1, len(data))]
    changed = bytearray(data)
    for _ in range(numbers.randint(1, 8)):
        changed[numbers.randrange(len(changed))] = numbers.choice([0, 1, 0x7F, 0x80, 0xFF, numbers.randrange(256)])
    return bytes(changed)


def render_mutations(runner, scene, ways, numbers):
    """Copies are in a folder of their own, with links to the files beside the scene."""
    data = scene.read_bytes()
    if not 0 < len(data) <= MAX_MUTATED:
        return
    folder = runner.folder / "mutated"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for other in scene.parent.iterdir():
        if other != scene:
            (folder / other.name).symlink_to(other.resolve())
    copy = folder / scene.name
    for i in range(runner.options.mutations):
        copy.write_bytes(mutated(data, numbers))
        if not runner.render(copy, numbers.choice(ways)) and runner.options.keep:
            runner.options.keep.mkdir(parents=True, exist_ok=True)
            shutil.copy(copy, runner.options.keep / f"{runner.findings}-{i}-{scene.name}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", type=pathlib.Path, metavar="FOLDER")
    parser.add_argument("--binary", type=pathlib.Path, default=ROOT / "build/debug/bin/alhazen")
    parser.add_argument("--size", type=int, default=16, help="pixels per side")
    parser.add_argument("--spp", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=5, help="--time-limit of each render")
    parser.add_argument("--timeout", type=float, default=300, help="seconds after which a run counts as endless")
    parser.add_argument("--ways", nargs="*", default=[], help="of " + ", ".join(WAYS) + "; parts of names suffice")
    parser.add_argument("--mutations", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="scenes whose path contains this text")
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--nan", action="store_true")
    parser.add_argument("--memcheck", action="store_true")
    options = parser.parse_args()
    if not options.binary.is_file():
        parser.error(f"{options.binary} does not exist: build it, or give --binary")
    ways = ways_of(options.binary, options.ways)
    scenes = [s for folder in options.folders for s in scenes_below(folder) if options.only in str(s)]
    if not scenes or not ways:
        parser.error("there is nothing to render: no scene, or no setting, has such a name")
    numbers = random.Random(options.seed)
    with tempfile.TemporaryDirectory() as folder:
        runner = Runner(options, pathlib.Path(folder))
        for scene in scenes:
            if options.mutations:
                render_mutations(runner, scene, ways, numbers)
            else:
                for way in ways:
                    runner.render(scene, way)
    print(f"{len(scenes)} scenes, {runner.runs} renders ({runner.refused} refused) by {', '.join(ways)}: "
          f"{runner.findings} findings")
    return 1 if runner.findings else 0


if __name__ == "__main__":
    sys.exit(main())
