#!/usr/bin/env python3
"""Draws the plots of a study, as PNG and SVG.

usage: python/alhazen/study_plots.py FOLDER [INTO]

FOLDER holds the study.json that `alhazen study report` wrote. The plots go to the folder INTO, by default the same.
Plots without measurements are omitted.
The program embeds this file and runs it at the end of a report.
"""

import json
import os
import sys
from pathlib import Path

import matplotlib
import matplotlib.pyplot as plt
import matplotlib.ticker
import numpy as np

COLOURS = {"blue": "#0b6e8f", "orange": "#d9762b", "green": "#4c8c4a", "red": "#b5424b", "grey": "#98a4af"}
CYCLE = [COLOURS[name] for name in ("blue", "orange", "green", "red", "grey")]


def set_style():
    plt.rcParams.update({
        "font.size": 10.5, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
        "grid.color": "#e3e8ec", "grid.linewidth": 0.8, "axes.axisbelow": True, "axes.edgecolor": "#5c6773",
        "axes.titlesize": 11.5, "legend.frameon": False, "svg.hashsalt": "alhazen", "figure.constrained_layout.use": True,
        "axes.prop_cycle": matplotlib.cycler(color=CYCLE),
    })


def short(value):
    """Three significant digits, never with an exponent."""
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


class Study:
    def __init__(self, folder, into):
        self.folder = folder
        self.into = into
        self.json = json.loads((folder / "study.json").read_text(encoding="utf-8"))
        self.tables = {table["id"]: table for table in self.json["tables"]}

    def cells(self, table, column=None, having=()):
        """The measured cells of a table, or of one of its columns, that have the quantity to be drawn: an interrupted
        study has cells without a baseline, and some that were not measured."""
        return [cell for cell in self.tables.get(table, {"cells": []})["cells"]
                if cell["status"] == "ok" and cell.get("seconds") and (column is None or cell["column"] == column)
                and all(cell.get(name) is not None for name in having)]

    def columns(self, table):
        return self.tables.get(table, {"columns": []})["columns"]

    def save(self, figure, name):
        write_whole(self.into / f"{name}.svg",
                    lambda path: figure.savefig(path, format="svg", metadata={"Date": None}))
        write_whole(self.into / f"{name}.png", lambda path: figure.savefig(path, format="png", dpi=150))
        plt.close(figure)


def write_whole(path, write):
    """An interrupted plot leaves no partial file."""
    temporary = path.with_name(f".{path.name}.tmp")
    try:
        write(temporary)
        os.replace(temporary, os.path.realpath(path))
    finally:
        temporary.unlink(missing_ok=True)


def error_of_speedup(cell):
    """Differences of the speedup at the slowest and the fastest repeat, not negative despite rounding."""
    seconds, speedup = cell["seconds"], cell["speedup"]
    return [max(0.0, speedup - speedup * seconds["median"] / seconds["max"]),
            max(0.0, speedup * seconds["median"] / seconds["min"] - speedup)]


def bars(axes, labels, cells, colours, unit="x"):
    """Horizontal bars from 0; hollow ones are in doubt, since other programs disturbed their runs."""
    positions = np.arange(len(cells))[::-1]
    values = [cell["speedup"] for cell in cells]
    errors = np.array([error_of_speedup(cell) for cell in cells]).T
    drawn = axes.barh(positions, values, color=colours, xerr=errors,
                      error_kw={"ecolor": "#5c6773", "elinewidth": 1, "capsize": 2})
    for bar, cell in zip(drawn, cells):
        if cell.get("doubt"):
            bar.set(edgecolor=bar.get_facecolor(), facecolor="white", linestyle="--")
    axes.set_yticks(positions, labels)
    axes.grid(axis="y", visible=False)
    for position, value, error, cell in zip(positions, values, errors[1], cells):
        axes.annotate(short(value) + unit + mark(cell), (value + error, position), xytext=(4, 0),
                      textcoords="offset points", va="center")
    axes.margins(x=0.12)


def mark(cell):
    return " ?" if cell.get("doubt") else ""


def draw_headline(study):
    """The best of every family, in float."""
    processors = study.json["machine"]["processors"]
    families = [("one core, iterative", "table1", lambda row: row.startswith("iterative"), "grey"),
                ("one core, Embree", "engines", lambda row: row == "Embree, 1 thread", "grey"),
                (f"OpenMP rows static, {processors} threads", "table3", lambda row: row == f"{processors} static", "blue"),
                (f"OpenMP rows dynamic, {processors} threads", "table3", lambda row: row == f"{processors} dynamic", "blue"),
                (None, "engines", lambda row: row.startswith("OpenMP tiles"), "blue"),
                (None, "engines", lambda row: row.startswith("Embree tiles"), "blue"),
                ("CUDA one thread per pixel", "table4", lambda row: True, "orange"),
                ("CUDA chunks", "table5", lambda row: True, "orange"),
                (None, "engines", lambda row: row.startswith("CUDA"), "orange"),
                ("OptiX", "optix", lambda row: True, "red")]
    labels, cells, colours = [], [], []
    for label, table, is_member, colour in families:
        members = [cell for cell in study.cells(table, "float", ["speedup"]) if is_member(cell["row"])]
        if members:
            best = max(members, key=lambda cell: (not cell.get("doubt"), cell["speedup"]))
            labels.append(label if label and table not in ("table4", "table5") else
                          f"{label}, {best['row']}" if label else best["row"])
            cells.append(best)
            colours.append(COLOURS[colour])
    if len(cells) < 2:
        return
    figure, axes = plt.subplots(figsize=(8.6, 0.9 + 0.42 * len(cells)))
    bars(axes, labels, cells, colours)
    axes.axvline(1, color="#5c6773", linewidth=1)
    if max(cell["speedup"] for cell in cells) > 20:
        axes.set_xscale("log")
    scale = ", logarithmic axis" if axes.get_xscale() == "log" else ""
    doubt = "; ?: in doubt" if any(cell.get("doubt") for cell in cells) else ""
    axes.set_xlabel(f"speedup over one core, float{scale} (whiskers: fastest and slowest repeat{doubt})",
                    fontsize=9.5)
    study.save(figure, "headline")


def draw_forms(study):
    """Both axes are linear and equal, so that the bars of here and of the report compare."""
    cells = [cell for cell in study.cells("table2", having=["speedup", "report"]) if cell["report"][0].get("seconds")]
    if len(cells) < 2:
        return
    report = {cell["row"]: 10524 / cell["report"][0]["seconds"] for cell in cells}
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.6, 2.6))
    names = [cell["row"] for cell in cells]
    bars(left, names, cells, COLOURS["blue"])
    left.set_title("here: speedup over one core")
    positions = np.arange(len(cells))[::-1]
    right.barh(positions, [report[name] for name in names], color=COLOURS["grey"])
    for position, name in zip(positions, names):
        right.annotate(f"{report[name]:.2f}x", (report[name], position), xytext=(4, 0), textcoords="offset points",
                       va="center")
    right.set_yticks(positions, ["" for _ in names])
    right.grid(axis="y", visible=False)
    right.set_title("the report: cuda2, 8 threads, float")
    largest = max([cell["speedup"] for cell in cells] + list(report.values()))
    for axes in (left, right):
        axes.set_xlim(0, 1.2 * largest)
    study.save(figure, "forms")


def draw_batches(study):
    """Times of one sample: the same form a path at a time and in batches."""
    columns = study.columns("batches")
    cells = study.cells("batches", having=["nanoseconds_per_sample"])
    if not cells:
        return
    rows = list(dict.fromkeys(cell["row"] for cell in cells))
    figure, axes = plt.subplots(figsize=(8.6, 3.2))
    positions, height = np.arange(len(rows))[::-1], 0.38
    for i, column in enumerate(columns):
        of_row = {cell["row"]: cell for cell in study.cells("batches", column, ["nanoseconds_per_sample"])}
        for position, row in zip(positions, rows):
            if row not in of_row:
                continue
            value = of_row[row]["nanoseconds_per_sample"]
            axes.barh(position + (0.5 - i) * height, value, height, color=CYCLE[i])
            axes.annotate(short(value) + " ns" + mark(of_row[row]), (value, position + (0.5 - i) * height),
                          xytext=(4, 0), textcoords="offset points", va="center", fontsize=9)
        axes.barh(0, 0, color=CYCLE[i], label=column)
    axes.set_yticks(positions, rows)
    axes.grid(axis="y", visible=False)
    axes.margins(x=0.12)
    values = [cell["nanoseconds_per_sample"] for cell in cells]
    is_log = max(values) > 30 * min(values)
    if is_log:
        axes.set_xscale("log")
        axes.set_xlim(min(values) / 2, 4 * max(values))
    axes.set_xlabel(f"nanoseconds per camera sample, float{', logarithmic axis' if is_log else ''} (?: in doubt)")
    axes.legend(loc="lower right")
    study.save(figure, "batches")


def draw_scaling(study):
    columns = [column for column in study.columns("table3") if study.cells("table3", column, ["speedup"])]
    if not columns:
        return
    processors = study.json["machine"]["processors"]
    figure, all_axes = plt.subplots(1, len(columns), figsize=(8.6, 3.6), sharey=True)
    for axes, column in zip(np.atleast_1d(all_axes), columns):
        lines = {}
        for cell in study.cells("table3", column, ["speedup"]):
            threads, schedule = cell["row"].split()
            lines.setdefault(schedule, []).append((int(threads), cell))
        largest = max(threads for line in lines.values() for threads, _ in line)
        counts = np.arange(1, largest + 1)
        axes.plot(counts, np.minimum(counts, processors), color="#5c6773", linestyle="--", linewidth=1,
                  label=f"ideal on {processors} processors")
        for schedule, line in lines.items():
            errors = np.array([error_of_speedup(cell) for _, cell in line]).T
            axes.errorbar([threads for threads, _ in line], [cell["speedup"] for _, cell in line], yerr=errors,
                          marker="o", markersize=4, capsize=2, linewidth=1.6, label=schedule)
        axes.set_title(column)
        axes.set_xlabel("threads")
        axes.set_ylim(bottom=0)
    np.atleast_1d(all_axes)[0].set_ylabel("speedup over one core")
    np.atleast_1d(all_axes)[-1].legend(loc="lower right")
    study.save(figure, "scaling")


def draw_gpu(study, table, name):
    """Speedups of a GPU table, double and float side by side."""
    rows = [row for row in study.tables.get(table, {"rows": []})["rows"]
            if any(cell["row"] == row for cell in study.cells(table, having=["speedup"]))]
    if not rows:
        return
    figure, axes = plt.subplots(figsize=(8.6, 3.2))
    positions, width = np.arange(len(rows)), 0.38
    for i, column in enumerate(study.columns(table)):
        values = {cell["row"]: cell["speedup"] for cell in study.cells(table, column, ["speedup"])}
        axes.bar(positions + (i - 0.5) * width, [values.get(row, 0) for row in rows], width, label=column)
    axes.set_xticks(positions, rows)
    axes.grid(axis="x", visible=False)
    axes.set_ylabel("speedup over one core")
    axes.legend()
    study.save(figure, name)


def read_pfm(path):
    with open(path, "rb") as file:
        kind, size, scale = (file.readline().split() for _ in range(3))
        width, height = (int(number) for number in size)
        if kind != [b"Pf"]:
            raise ValueError(f"{path} is no grey PFM")
        order = "<" if float(scale[0]) < 0 else ">"
        return np.frombuffer(file.read(), dtype=order + "f4").reshape(height, width)[::-1]


def draw_figure3(study):
    figure3 = study.json.get("figure3")
    if not figure3 or not all((study.folder / figure3[name]["picture"]).is_file() for name in ("naive", "chunked")):
        return
    naive, chunked = (read_pfm(study.folder / figure3[name]["picture"]) for name in ("naive", "chunked"))
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.6, 4.1))
    top = max(figure3["naive"]["largest"], figure3["chunked"]["largest"])
    for axes, values, facts, title in ((left, naive, figure3["naive"], "one thread per pixel"),
                                       (right, chunked, figure3["chunked"], f"{figure3['chunks']} chunks")):
        image = axes.imshow(values, cmap="inferno", vmin=1, vmax=top, interpolation="nearest")
        axes.set_title(f"{title}: mean {facts['mean']:.2f}, largest {facts['largest']:.2f}")
        axes.set_xlabel(f"{facts['threads_x']} x {facts['threads_y']} threads")
        axes.set_xticks([])
        axes.set_yticks([])
        for spine in axes.spines.values():
            spine.set_visible(False)
    figure.colorbar(image, ax=[left, right], label="mean segments of a thread's paths", shrink=0.85)
    study.save(figure, "figure3")


def draw_balance(study):
    cells = study.cells("balance", "float", ["busiest_over_mean"])
    if not cells:
        return
    figure, axes = plt.subplots(figsize=(8.6, 2.6))
    positions = np.arange(len(cells))[::-1]
    values = [cell["busiest_over_mean"] for cell in cells]
    axes.barh(positions, np.array(values) - 1, left=1, color=COLOURS["blue"])
    for position, value in zip(positions, values):
        axes.annotate(f"{value:.3f}", (value, position), xytext=(4, 0), textcoords="offset points", va="center")
    axes.set_yticks(positions, [cell["row"] for cell in cells])
    axes.grid(axis="y", visible=False)
    axes.set_xlim(1, 1 + 1.15 * max(0.02, max(values) - 1))
    axes.set_xlabel("busiest thread over mean, float (1: all threads end together)")
    study.save(figure, "balance")


def draw_queries(study):
    columns = study.columns("queries")
    cells = study.cells("queries", having=["nanoseconds_per_ray"])
    if not cells:
        return
    rows = list(dict.fromkeys(cell["row"] for cell in cells))
    figure, axes = plt.subplots(figsize=(8.6, 2.8))
    positions, height = np.arange(len(rows))[::-1], 0.38
    for i, column in enumerate(columns):
        values = {cell["row"]: cell["nanoseconds_per_ray"] for cell in study.cells("queries", column, ["nanoseconds_per_ray"])}
        for position, row in zip(positions, rows):
            if row in values:
                place = position + (0.5 - i) * height
                axes.barh(place, values[row], height, color=CYCLE[i], label=column if row == rows[0] else None)
                axes.annotate(short(values[row]) + " ns", (values[row], place), xytext=(4, 0), textcoords="offset points",
                              va="center", fontsize=9)
    axes.set_yticks(positions, rows)
    axes.grid(axis="y", visible=False)
    axes.margins(x=0.12)
    axes.set_xlabel("nanoseconds per ray, one thread, shading included")
    axes.legend(loc="lower right")
    study.save(figure, "queries")


def draw_depth(study, table, name):
    """Rays and time of a camera sample, each on a linear axis, where 2^D explodes, and beside it on a logarithmic one,
    where it is a line and the small values can be read."""
    needed = ["rays_per_sample", "nanoseconds_per_sample"]
    columns = [column for column in study.columns(table) if study.cells(table, column, needed)]
    if not columns:
        return
    figure, all_axes = plt.subplots(2, 2, figsize=(8.6, 6.4), sharex=True)
    depths = np.arange(1, 13)
    most = max(cell["rays_per_sample"] for cell in study.cells(table, having=needed))
    shown = depths[2.0 ** depths - 1 <= 2 * most]
    quantities = (("rays per camera sample", lambda cell: cell["rays_per_sample"]),
                  ("microseconds per camera sample", lambda cell: cell["nanoseconds_per_sample"] / 1000))
    for row, (title, value) in zip(all_axes, quantities):
        for axes, is_log in zip(row, (False, True)):
            for column in columns:
                cells = study.cells(table, column, needed)
                colour, line = {"branching": ("orange", "-"), "recursive": ("green", "--")}.get(column.split()[0],
                                                                                               ("blue", "-"))
                axes.plot([int(cell["row"]) for cell in cells], [value(cell) for cell in cells], marker="o", markersize=4,
                          linewidth=1.6, label=column, linestyle=line, color=COLOURS[colour])
            if title.startswith("rays"):
                axes.plot(shown, 2.0 ** shown - 1, color="#98a4af", linestyle=":", label="all of them branch: $2^D - 1$")
            axes.set_title(f"{title}: {'logarithmic' if is_log else 'linear'} axis", fontsize=10)
            axes.set_xticks(depths[1::2])
            if not is_log:
                axes.set_ylim(bottom=0)
                continue
            axes.set_yscale("log")
            axes.yaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:g}"))
            axes.yaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())
            low, high = axes.get_ylim()
            if high < 50 * low:
                axes.yaxis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
    for axes in all_axes[1]:
        axes.set_xlabel("D, maximum number of segments of a path")
    all_axes[0][0].legend(fontsize=9)
    study.save(figure, name)


def draw_objects(study):
    if not study.cells("objects", having=["nanoseconds_per_ray"]):
        return
    figure, axes = plt.subplots(figsize=(8.6, 3.6))
    for column in study.columns("objects"):
        cells = study.cells("objects", column, ["nanoseconds_per_ray"])
        axes.plot([int(cell["row"]) for cell in cells], [cell["nanoseconds_per_ray"] for cell in cells], marker="o",
                  markersize=4, linewidth=1.6, label=column)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("spheres, logarithmic axis")
    axes.set_ylabel("nanoseconds per ray, logarithmic axis")
    axes.legend()
    study.save(figure, "objects")


def draw_error(study):
    figure, axes = plt.subplots(figsize=(8.6, 3.6))
    for column in study.columns("error"):
        cells = [cell for cell in study.cells("error", column, ["rmse"]) if cell["rmse"] > 0]
        if not cells:
            continue
        axes.plot([cell["seconds"]["median"] for cell in cells], [cell["rmse"] for cell in cells], marker="o",
                  markersize=5, linewidth=1.6, label=column)
        for cell in cells:
            axes.annotate(f"S = {cell['row']}", (cell["seconds"]["median"], cell["rmse"]), xytext=(5, 5),
                          textcoords="offset points", fontsize=9, color="#5c6773")
    if axes.lines:
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel("seconds, logarithmic axis (S: samples per pixel)")
        axes.set_ylabel("RMSE, logarithmic axis")
        axes.legend()
        study.save(figure, "error")
    plt.close(figure)


PLOTS = {"headline": draw_headline, "forms": draw_forms, "batches": draw_batches, "scaling": draw_scaling,
         "blocks": lambda study: draw_gpu(study, "table4", "blocks"),
         "chunks": lambda study: draw_gpu(study, "table5", "chunks"),
         "figure3": draw_figure3, "balance": draw_balance, "queries": draw_queries,
         "depth": lambda study: draw_depth(study, "depth", "depth"),
         "glass": lambda study: draw_depth(study, "glass", "glass"),
         "objects": draw_objects, "error": draw_error}


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__.strip())
    plt.switch_backend("Agg")
    set_style()
    study = Study(Path(sys.argv[1]), Path(sys.argv[-1]))
    failures = []
    for name, draw in PLOTS.items():
        try:
            draw(study)
        except Exception as error:  # the other plots are still drawn
            failures.append(f"{name} ({type(error).__name__}: {error})")
    if failures:
        sys.exit("; ".join(failures))


if __name__ == "__main__":
    main()
