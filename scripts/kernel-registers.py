#!/usr/bin/env python3
"""Prints registers, stack and spills of every CUDA kernel, as reported by ptxas.

usage: scripts/kernel-registers.py [--build build/release] [--arch 90]
Compiles the kernels again for one architecture, with the options of the build. Also the target `kernel_registers`.
"""

import argparse
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

FUNCTION = re.compile(r"Compiling entry function '(\w+)' for '(\w+)'")
FRAME = re.compile(r"(\d+) bytes stack frame, (\d+) bytes spill stores, (\d+) bytes spill loads")
REGISTERS = re.compile(r"Used (\d+) registers")


def compile_commands(build):
    with open(build / "compile_commands.json", encoding="utf-8") as file:
        for entry in json.load(file):
            if entry["file"].endswith(".cu"):
                yield Path(entry["file"]), shlex.split(entry["command"]), entry["directory"]


def ptxas_report(command, directory, arch):
    with tempfile.TemporaryDirectory() as folder:
        kept, skip = [], False
        for word in command:
            if skip:
                skip = False
            elif word in ("-o", "-MF", "-MT"):
                skip = True
            elif not (word.startswith("--generate-code") or word.startswith("-gencode") or word in ("-MD", "-c")
                      or word.startswith("-arch") or word.startswith("-Werror")):
                kept.append(word)
        kept += [f"-arch=sm_{arch}", "-cubin", "-Xptxas=-v", "-o", os.path.join(folder, "kernels.cubin")]
        done = subprocess.run(kept, cwd=directory, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{shlex.join(kept)}\n{done.stderr}")
        return done.stderr


def demangle(names):
    done = subprocess.run(["c++filt"], input="\n".join(names), capture_output=True, text=True, check=False)
    return done.stdout.splitlines() if done.returncode == 0 else names


def short_name(name):
    """PersistentKernel<WideTracing, path, float> of the mangled name's long form."""
    name = re.sub(r"\(alhazen::impl::IntegratorKind\)2", "iterative", name)
    name = re.sub(r"\(alhazen::impl::IntegratorKind\)3", "path", name)
    match = re.search(r"run_kernel<alhazen::impl::cuda::(.*)>\(", name)
    return re.sub(r"alhazen::impl::(cuda::)?", "", match.group(1)) if match else name


def parse(report):
    rows, function = [], None
    for line in report.splitlines():
        if match := FUNCTION.search(line):
            function = match.group(1)
        elif (match := FRAME.search(line)) and function:
            frame = [int(value) for value in match.groups()]
        elif (match := REGISTERS.search(line)) and function:
            rows.append((function, int(match.group(1)), *frame))
            function = None
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, default=Path("build/release"))
    parser.add_argument("--arch", default="90")
    options = parser.parse_args()
    commands = list(compile_commands(options.build))
    if not commands:
        sys.exit(f"{options.build} was configured without CUDA: there are no kernels")
    print(f"sm_{options.arch}\n{'kernel':<52} {'registers':>9} {'stack':>6} {'spilled':>8}")
    for _, command, directory in commands:
        rows = parse(ptxas_report(command, directory, options.arch))
        names = demangle([row[0] for row in rows])
        for name, (_, registers, stack, stores, loads) in sorted(zip(map(short_name, names), rows)):
            print(f"{name:<52} {registers:>9} {stack:>6} {stores + loads:>8}")


if __name__ == "__main__":
    main()
