#!/usr/bin/env python3
"""Runs the benchmarks with interleaved repeats and prints medians as ratios to the serial engine.

usage: scripts/bench.py [--binary build/release/bench/alhazen_bench] [--repeats 5] [--filter REGEX] [--json FILE]
"""

import argparse
import json
import statistics
import subprocess
import sys


def run(binary, repeats, pattern):
    command = [binary, f"--benchmark_repetitions={repeats}", "--benchmark_enable_random_interleaving=true",
               "--benchmark_format=json", "--benchmark_min_time=0.2"]
    if pattern:
        command.append(f"--benchmark_filter={pattern}")
    finished = subprocess.run(command, stdout=subprocess.PIPE, check=False)
    if finished.returncode != 0:
        sys.exit(f"{binary} failed with exit code {finished.returncode}")
    return json.loads(finished.stdout)


def times_by_name(report):
    times = {}
    for entry in report["benchmarks"]:
        if entry["run_type"] == "iteration":
            name = entry["run_name"].removesuffix("/real_time")
            times.setdefault(name, []).append(entry["real_time"])
    return times


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--binary", default="build/release/bench/alhazen_bench")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--filter", default="")
    parser.add_argument("--json", help="write the raw report here")
    options = parser.parse_args()
    report = run(options.binary, options.repeats, options.filter)
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(report, file, indent=1)
    times = times_by_name(report)
    print(f"{'render of scenes/spheres.pbrt':<34} {'median ms':>10} {'min':>9} {'max':>9} {'speed-up':>9}")
    for name, values in sorted(times.items()):
        base = times.get(name.split("/")[0] + "/serial")
        median = statistics.median(values)
        speedup = f"{statistics.median(base) / median:9.2f}" if base else ""
        print(f"{name:<34} {median:10.1f} {min(values):9.1f} {max(values):9.1f} {speedup}")


if __name__ == "__main__":
    main()
