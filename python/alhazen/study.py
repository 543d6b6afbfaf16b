"""Reads what `alhazen study report` writes: its tables as NumPy arrays, and its plots.

    study = alhazen.study.load("study/")
    print(study)
    table = study["table3"]
    print(table.grid("speedup"))
    study.plot("scaling")
"""

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Dict, List, Optional, Sequence, Union

import numpy as np

SCHEMA = "alhazen-study-1"

#: The numbers of a cell, by their names in arrays: where they are in study.json, and what they are.
QUANTITIES = {
    "seconds": (("seconds", "median"), "median of the repeats"),
    "min_seconds": (("seconds", "min"), "fastest repeat"),
    "max_seconds": (("seconds", "max"), "slowest repeat"),
    "speedup": (("speedup",), "over the table's baseline"),
    "nanoseconds_per_sample": (("nanoseconds_per_sample",), "of a camera sample"),
    "nanoseconds_per_ray": (("nanoseconds_per_ray",), "of a ray or shadow ray"),
    "rays_per_sample": (("rays_per_sample",), "rays and shadow rays of a camera sample"),
    "busiest_over_mean": (("busiest_over_mean",), "time of the busiest thread over the mean"),
    "gini": (("gini",), "Gini coefficient of the threads' times"),
    "rmse": (("rmse",), "root mean squared error"),
    "spp": (("spp",), "samples per pixel"),
}


@dataclass(frozen=True)
class Table:
    """A table of a study.

    `array` is a structured array with an element for each cell: row, column, status ("ok" if it was measured), the
    numbers of QUANTITIES, which are NaN where there are none, doubt (why the figure is in doubt, or ""), and trial, by
    which Study.trial finds the runs.
    """

    id: str
    title: str
    text: str
    row_title: str
    measure: str
    rows: List[str]
    columns: List[str]
    array: np.ndarray = field(repr=False)
    cells: List[Dict[str, Any]] = field(repr=False)  #: as study.json has them

    def cell(self, row: str, column: Optional[str] = None) -> np.void:
        """The cell of a row and a column; the column may be left out where the row has one cell. Raises KeyError."""
        found = self.array[self.array["row"] == row]
        if column is not None:
            found = found[found["column"] == column]
        if len(found) != 1:
            problem = "no cell" if len(found) == 0 else "more than one cell: name the column as well,"
            raise KeyError(f"{self.id} has {problem} at {row!r}{'' if column is None else ', ' + repr(column)}; "
                           f"its rows are {self.rows}, its columns {self.columns}")
        return found[0]

    def grid(self, quantity: str = "seconds") -> np.ndarray:
        """A quantity as an array of the shape (rows, columns), NaN where there is none."""
        if quantity not in QUANTITIES:
            raise KeyError(f"there is no quantity {quantity!r}: there are {', '.join(QUANTITIES)}")
        values = np.full((len(self.rows), len(self.columns)), np.nan)
        for cell in self.array:
            values[self.rows.index(cell["row"]), self.columns.index(cell["column"])] = cell[quantity]
        return values


@dataclass(frozen=True)
class Study:
    """A study: `tables` by their ids, and what was measured with what, on which machine, as plain records."""

    folder: Path
    version: str
    date: str
    complete: bool
    machine: Dict[str, Any]
    build: Dict[str, Any]
    scene: Dict[str, Any]
    scale: Dict[str, Any]
    conditions: List[Dict[str, Any]] = field(repr=False)
    tables: Dict[str, Table] = field(repr=False)
    trials: List[Dict[str, Any]] = field(repr=False)
    json: Dict[str, Any] = field(repr=False)  #: all of study.json

    def __getitem__(self, table: str) -> Table:
        if table not in self.tables:
            raise KeyError(f"there is no table {table!r}: there are {', '.join(self.tables)}")
        return self.tables[table]

    def trial(self, key: str) -> Dict[str, Any]:
        """The runs of a cell, by its `trial`: every repeat's time, and what disturbed it."""
        for trial in self.trials:
            if trial["key"] == key:
                return trial
        raise KeyError(f"there is no trial {key!r}")

    def plot(self, name: Optional[str] = None, style: bool = True):
        """Draws a plot of the report by matplotlib: headline, forms, batches, scaling, blocks, chunks, figure3,
        balance, queries, depth, glass, objects, error.

        Returns its matplotlib.figure.Figure, or None if the study has no measurements for it. Without a name all are
        drawn, and a dict of the figures is returned. style: False keeps matplotlib's own settings.
        """
        from . import study_plots as plots
        if name is not None and name not in plots.PLOTS:
            raise KeyError(f"there is no plot {name!r}: there are {', '.join(plots.PLOTS)}")
        drawn = _Drawn(self)
        with plots.plt.rc_context():
            if style:
                plots.set_style()
            for each in plots.PLOTS if name is None else [name]:
                plots.PLOTS[each](drawn)
        return drawn.figures if name is None else drawn.figures.get(name)

    def __str__(self):
        scene, machine = self.scene, self.machine
        lines = [f"Study of {scene['name']}, {scene['width']} x {scene['height']}, {self.date}, on "
                 f"{machine['processor']}, {machine['processors']} processors"
                 f"{'' if self.complete else ', not complete'}"]
        lines += [f"  {table.id:<10} {table.title}: {len(table.rows)} x {len(table.columns)}"
                  for table in self.tables.values()]
        return "\n".join(lines)


def _Drawn(study: Study):
    """The study as the functions that draw take it; it keeps their figures."""
    from . import study_plots as plots

    class Drawn(plots.Study):
        def __init__(self):
            self.folder = study.folder
            self.json = study.json
            self.tables = {table["id"]: table for table in study.json["tables"]}
            self.figures = {}

        def save(self, figure, name):
            self.figures[name] = figure
            plots.plt.close(figure)

    return Drawn()


def load(path: Union[str, "Path"]) -> Study:
    """Reads a study: the folder that `alhazen study report` wrote, or its study.json.

    Raises FileNotFoundError if there is none, ValueError for a file that is none.
    """
    path = Path(path)
    file = path / "study.json" if path.is_dir() else path
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
        if content["schema"] != SCHEMA:
            raise ValueError(f"it has the schema {content['schema']!r}, and this version reads {SCHEMA!r}")
        tables = {table["id"]: _table(table) for table in content["tables"]}
        return Study(file.parent, content["version"], content["date"], content["complete"], content["machine"],
                     content["build"], content["scene"], content["scale"], content["conditions"], tables,
                     content["trials"], content)
    except (ValueError, KeyError, TypeError) as problem:
        cause = f"it lacks {problem}" if isinstance(problem, KeyError) else str(problem)
        raise ValueError(f"{file}: not a study of alhazen: {cause}") from problem


def _table(table):
    return Table(table["id"], table["title"], table["text"], table["row_title"], table["measure"], table["rows"],
                 table["columns"], _array(table["cells"]), table["cells"])


def _array(cells: Sequence[Dict[str, Any]]) -> np.ndarray:
    texts = ("row", "column", "status", "doubt", "trial")
    columns = {name: np.array([cell.get(name) or "" for cell in cells], dtype=np.str_) for name in texts}
    columns.update({name: np.array([_number(cell, path) for cell in cells], dtype=float)
                    for name, (path, _) in QUANTITIES.items()})
    order = ("row", "column", "status", *QUANTITIES, "doubt", "trial")
    array = np.empty(len(cells), dtype=[(name, columns[name].dtype) for name in order])
    for name in order:
        array[name] = columns[name]
    return array


def _number(cell, path):
    value = cell
    for name in path:
        value = value.get(name) if isinstance(value, dict) else None
    return np.nan if value is None else value
