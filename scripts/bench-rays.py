#!/usr/bin/env python3
"""Compares traversal, whole renders and builds with Embree: interleaved repeats in one run, medians, ratios.

usage: scripts/bench-rays.py [--binary build/release/bench/alhazen_bench] [--mesh MESH.ply] [--repeats 5]
                             [--filter REGEX] [--than ENGINE] [--cpu] [--json FILE] [--markdown]

Each group of the same rays, renders or builds is compared with Embree's line in it, or with that of another engine. A
ratio above 1 is faster than that.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys


def run(options):
    command = [options.binary, f"--benchmark_repetitions={options.repeats}", "--benchmark_min_time=0.05",
               "--benchmark_enable_random_interleaving=true", "--benchmark_format=json",
               f"--benchmark_filter={options.filter}"]
    environment = dict(os.environ)
    if options.mesh:
        environment["ALHAZEN_BENCH_MESH"] = os.path.abspath(options.mesh)
    finished = subprocess.run(command, stdout=subprocess.PIPE, env=environment, check=False)
    if finished.returncode != 0:
        sys.exit(f"bench-rays: {options.binary} failed with exit code {finished.returncode}")
    return json.loads(finished.stdout)


def groups_of(report, clock):
    """{group: {engine: (milliseconds of each repeat, number of rays or None, bytes per triangle or None)}}"""
    groups = {}
    for entry in report["benchmarks"]:
        if entry["run_type"] != "iteration":
            continue
        name = entry["run_name"].removesuffix("/real_time").removesuffix("/manual_time")
        group, engine = name.rsplit("/", 1)
        rated_by = "real_time" if entry["run_name"].endswith("_time") else "cpu_time"
        rays = entry["rays"] * entry[rated_by] / 1e3 if "rays" in entry else None
        line = groups.setdefault(group, {}).setdefault(engine, ([], rays, entry.get("bytes a triangle")))
        line[0].append(entry[clock])
    return groups


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--binary", default="build/release/bench/alhazen_bench")
    parser.add_argument("--mesh", help="the mesh of the scene 'knot' (default: scenes/knot.ply.gz)")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--filter", default="^(rays|whole|build)/")
    parser.add_argument("--than", default="float embree", help="the engine that ratios are to")
    parser.add_argument("--cpu", action="store_true",
                        help="processor time of the one thread, where other programs run meanwhile")
    parser.add_argument("--json", help="write the raw report here")
    parser.add_argument("--markdown", action="store_true", help="tables for docs/results")
    options = parser.parse_args()
    if not os.access(options.binary, os.X_OK):
        sys.exit(f"bench-rays: {options.binary} does not exist: build it first (scripts/build.sh alhazen_bench)")
    report = run(options)
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(report, file, indent=1)
    row = "| {} | {} | {} | {} | {} |" if options.markdown else "{:<26} {:<42} {:>24} {:>9} {:>9}"
    print(row.format("what", "engine", "median ms (min to max)", "Mrays/s", "ratio"))
    if options.markdown:
        print("|---|---|---|---|---|")
    for group, engines in sorted(groups_of(report, "cpu_time" if options.cpu else "real_time").items()):
        than = engines.get(options.than)
        for engine, (times, rays, memory) in sorted(engines.items(), key=lambda line: line[0].split(" ")[::-1]):
            median = statistics.median(times)
            speed = f"{rays / median / 1e3:.1f}" if rays else f"{memory:.0f} B/tri" if memory else ""
            ratio = f"{statistics.median(than[0]) / median:.2f}" if than else ""
            print(row.format(group, engine, f"{median:.1f} ({min(times):.1f} to {max(times):.1f})", speed, ratio))


if __name__ == "__main__":
    main()
