#!/usr/bin/env python3
"""Prints and plots a study that `alhazen study report` has measured.

    alhazen study report -o study
    python3 plot_study.py study --output plots

The tables are NumPy arrays: this script draws a plot of its own from one, then the report's plots as PNG files.
"""

import argparse
from pathlib import Path

import matplotlib
import numpy as np

import alhazen

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def speedups(table):
    """Bars of every row over the table's baseline, a color for each column."""
    grid = table.grid("speedup")
    figure, axes = plt.subplots(figsize=(8, 0.45 * len(table.rows) + 1.2), layout="constrained")
    places, height = np.arange(len(table.rows)), 0.8 / len(table.columns)
    for number, column in enumerate(table.columns):
        axes.barh(places + (number + 0.5) * height - 0.4, np.nan_to_num(grid[:, number]), height, label=column)
    axes.set_yticks(places, table.rows)
    axes.invert_yaxis()
    axes.set_xlabel("speedup")
    axes.set_title(table.title)
    axes.legend()
    return figure


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", type=Path, help="folder of a study, or its study.json")
    parser.add_argument("--table", default="table3", help="the one to print and to plot")
    parser.add_argument("--output", type=Path, default=Path("plots"), help="folder of the PNG files")
    options = parser.parse_args()

    study = alhazen.study.load(options.study)
    print(study)
    table = study[options.table]
    print(f"\n{table.title}")
    for cell in table.array:
        print(f"  {cell['row']:<28} {cell['column']:<16} {cell['seconds']:8.3f} s  {cell['speedup']:6.2f}x")

    options.output.mkdir(parents=True, exist_ok=True)
    figures = {f"speedups-{options.table}": speedups(table), **study.plot()}
    for name, figure in figures.items():
        figure.savefig(options.output / f"{name}.png", dpi=120)
    print(f"\n{options.output}: {', '.join(figures)}")


if __name__ == "__main__":
    main()
