"""Comparing images, devices, studies, and the progress bar."""

import io
import json
import subprocess
import sys
import types

import numpy as np
import pytest

import alhazen
from common import CORNELL, run_program, start_python


@pytest.fixture(scope="module")
def pair(tmp_path_factory):
    """Two images of a scene and their files."""
    folder = tmp_path_factory.mktemp("compare")
    images = [alhazen.render(CORNELL, spp=spp, width=60, height=40, layers=["albedo"]) for spp in (4, 64)]
    files = [folder / "a.exr", folder / "b.exr"]
    for image, file in zip(images, files):
        image.save(file, exr_type="float")
    return images, files


MEASURES = ("mse", "rmse", "relmse", "relmse_trimmed", "psnr", "ssim", "flip", "mean_a", "mean_b", "max_abs",
            "nonfinite_a", "nonfinite_b", "nonfinite_in_one", "compared")


@pytest.mark.parametrize("arguments, options", [
    ({}, []), (dict(layer="albedo"), ["--layer", "albedo"]), (dict(reduce=4), ["--reduce", 4]),
    (dict(region=(3, 4, 50, 30)), ["--region", "3,4,50,30"])])
def test_measures_are_those_of_the_program(pair, arguments, options):
    (a, b), files = pair
    printed = json.loads(run_program("compare", *files, "--json", *options))
    if "layers" in printed:
        printed = printed["layers"]["albedo"]
    results = [alhazen.compare(a, b, **arguments), alhazen.compare(*files, **arguments),
               alhazen.compare(str(files[0]), b, **arguments)]
    if "layer" not in arguments:
        results.append(alhazen.compare(np.asarray(a), np.asarray(b), **arguments))
    for result in results:
        assert {name: getattr(result, name) for name in MEASURES} == printed
    if not arguments:
        assert results[0].flip > 0.01 and results[0].psnr > 10


def test_maps(pair, tmp_path):
    (a, b), files = pair
    result = alhazen.compare(a, b)
    assert result.flip_map.shape == (40, 60) and result.flip_map.dtype == np.float32
    assert result.flip_map.mean() == pytest.approx(result.flip, rel=1e-5)
    assert np.shares_memory(result.flip_map, result.flip_map) and not result.flip_map.flags.writeable
    run_program("compare", *files, "--heat-map", tmp_path / "program.pfm")
    np.testing.assert_array_equal(result.heat_map, alhazen.read_image(tmp_path / "program.pfm"))
    flip_map = result.flip_map
    del result
    assert np.isfinite(flip_map).all()


def test_equal_and_damaged_images():
    ones = np.ones((8, 9, 3))
    same = alhazen.compare(ones, ones)
    assert (same.flip, same.mse, same.psnr, same.compared) == (0, 0, np.inf, 72)
    assert repr(same) == "<alhazen.Comparison: FLIP 0, relMSE 0, PSNR inf dB, SSIM 1>"
    damaged = ones.copy()
    damaged[2, 3, 1] = np.nan
    assert alhazen.compare(damaged, ones).nonfinite_a == 1 and alhazen.compare(damaged, ones).compared == 71
    assert alhazen.compare(ones[..., 0], ones[..., 0] * 2).max_abs == 1
    with_alpha = np.concatenate([ones, ones[..., :1] * 0.5], axis=2)
    assert alhazen.compare(with_alpha, ones).mse == 0


def test_what_cannot_be_compared(pair, tmp_path):
    (a, b), files = pair
    for arguments, message in (((a, np.ones((3, 4, 3))), "differ in size"), ((a, 7), "'b'"),
                               ((tmp_path / "nothing.exr", b), "nothing.exr"),
                               ((np.ones((2, 2, 3), np.uint8), b), "'a'"), ((np.zeros((0, 2, 3)), b), "a: ")):
        with pytest.raises(alhazen.InputError, match=message):
            alhazen.compare(*arguments)
    for arguments, message in ((dict(layer="smell"), "smell"), (dict(region=(0, 0, 99, 1)), "region"),
                               (dict(region=(1, 2)), "'region'"), (dict(reduce=0), "'reduce'"),
                               (dict(reduce=50), "reduced by 50")):
        with pytest.raises(alhazen.InputError, match=message):
            alhazen.compare(a, b, **arguments)


def test_devices_are_those_of_the_program():
    devices = alhazen.devices()
    printed = json.loads(run_program("devices", "--json"))
    assert [backend.name for backend in devices.backends] == [backend["name"] for backend in printed["backends"]]
    for backend, expected in zip(devices.backends, printed["backends"]):
        for name in ("available", "details", "devices", "strategies"):
            assert getattr(backend, name) == expected[name]
        assert (backend.module or "") == expected["module"]
    for denoiser, expected in zip(devices.denoisers, printed["denoisers"]):
        assert dict(name=denoiser.name, available=denoiser.available, details=denoiser.details) == expected
    assert devices.processors >= 1 and devices.processor and "AVX" in " ".join(devices.instruction_sets).upper()
    assert devices.gpus == [] or all(isinstance(gpu, str) for gpu in devices.gpus)
    assert repr(devices).startswith("<alhazen.Devices: ") and "serial" in repr(devices)
    assert "BackendInfo serial: " in repr(devices.backends[0])


def study_json():
    """What a study of one table writes, as src/study/json.cpp has it."""
    def cell(row, column, median, **others):
        return {"row": row, "column": column, "status": "ok", "trial": f"--{row} {column}", "spp": 8,
                "speedup": 2 / median, "seconds": {"median": median, "min": median / 2, "max": median * 2, "samples": [median]}, **others}
    cells = [cell("1 static", "double", 2.0), cell("1 static", "float", 1.0, doubt="it was disturbed"),
             cell("2 static", "double", 1.0), {"row": "2 static", "column": "float", "status": "failed", "trial": "x"}]
    table = {"id": "table3", "title": "Table 3: threads", "text": "", "row_title": "threads", "measure": "seconds",
             "columns": ["double", "float"], "rows": ["1 static", "2 static"], "cells": cells}
    return {"schema": "alhazen-study-1", "version": "0.1.0", "date": "2026-01-31", "complete": False, "seconds": 9,
            "machine": {"processor": "an abacus", "processors": 2, "engines": []}, "build": {}, "conditions": [],
            "scene": {"name": "spheres.pbrt", "width": 80, "height": 60}, "scale": {"name": "quick"}, "tables": [table],
            "trials": [{"key": "--1 static float", "status": "ok"}]}


@pytest.fixture()
def study(tmp_path):
    (tmp_path / "study.json").write_text(json.dumps(study_json()))
    return alhazen.study.load(tmp_path)


def test_studies(study, tmp_path):
    table = study["table3"]
    np.testing.assert_array_equal(table.grid("seconds"), [[2, 1], [1, np.nan]])
    np.testing.assert_array_equal(table.grid("speedup"), [[1, 2], [2, np.nan]])
    assert table.array.dtype.names[:3] == ("row", "column", "status")
    cell = table.cell("1 static", "float")
    assert (cell["min_seconds"], cell["max_seconds"], cell["doubt"]) == (0.5, 2, "it was disturbed")
    assert np.isnan(cell["rmse"]) and table.array["status"][3] == "failed"
    assert study.trial(cell["trial"])["status"] == "ok" and not study.complete
    assert "Study of spheres.pbrt, 80 x 60, 2026-01-31, on an abacus, 2 processors, not complete" in str(study)
    assert alhazen.study.load(tmp_path / "study.json").tables.keys() == {"table3"}
    for wrong, message in ((lambda: study["table9"], "there are table3"), (lambda: table.grid("beauty"), "there are"),
                           (lambda: table.cell("1 static"), "more than one cell"),
                           (lambda: table.cell("9", "float"), "no cell"), (lambda: study.trial("?"), "no trial"),
                           (lambda: study.plot("smell"), "there are headline")):
        with pytest.raises(KeyError, match=message):
            wrong()


def test_files_that_are_no_studies(tmp_path):
    with pytest.raises(FileNotFoundError):
        alhazen.study.load(tmp_path)
    file = tmp_path / "study.json"
    for content, message in (("{", "not a study"), ('{"schema": "alhazen-study-9"}', "alhazen-study-9"),
                             ('{"schema": "alhazen-study-1"}', "it lacks 'tables'"), ("[]", "not a study")):
        file.write_text(content)
        with pytest.raises(ValueError, match=message):
            alhazen.study.load(tmp_path)


def test_plots_of_studies(study):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    before = dict(matplotlib.rcParams)
    figure = study.plot("scaling")
    assert isinstance(figure, matplotlib.figure.Figure) and len(figure.axes) == 2
    assert dict(matplotlib.rcParams) == before and not matplotlib.pyplot.get_fignums()
    assert study.plot("depth") is None
    assert list(study.plot()) == ["scaling"]


def test_matplotlib_is_imported_for_plots_alone():
    code = "import sys, alhazen, alhazen.study; print('matplotlib' in sys.modules, 'IPython' in sys.modules)"

    output, errors = start_python(code).communicate()
    assert output == "False False\n", errors


def progress(fraction, seconds, noise=0.0):
    return types.SimpleNamespace(fraction=fraction, seconds=seconds, samples_done=int(1000 * fraction),
                                 samples_total=1000, samples_loaded=0, pixels=10, noise=noise)


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_the_bar_on_a_terminal():
    terminal = Terminal()
    bar = alhazen.ProgressBar("cornell", terminal, width=10)
    bar(progress(0.25, 3))
    bar(progress(0.5, 61, noise=0.0123))
    bar(progress(1, 3600))
    lines = terminal.getvalue().split("\r")
    assert lines[1] == "cornell [##--------]  25.0 %, 0:03, 0:09 left"
    assert lines[2] == "cornell [#####-----]  50.0 %, 1:01, 1:01 left, noise 0.0123"
    assert lines[3].startswith("cornell [##########] 100.0 %, 1:00:00 ") and lines[3].endswith("\n")
    bar.close()
    assert terminal.getvalue().count("\n") == 1


def test_the_bar_ends_its_line_when_a_render_is_stopped():
    terminal = Terminal()
    bar = alhazen.ProgressBar(file=terminal)
    bar(progress(0.25, 3))
    assert "\n" not in terminal.getvalue()
    del bar
    assert terminal.getvalue().endswith("\n")


def test_the_bar_in_a_file():
    file = io.StringIO()
    bar = alhazen.ProgressBar(file=file, width=4)
    for step in range(101):
        bar(progress(step / 100, step / 10))
    lines = file.getvalue().splitlines()
    assert [line.split("%")[0] for line in lines] == ["[----]   0.0 ", "[##--]  50.0 ", "[####] 100.0 "]


def test_the_bar_of_a_render(capfd):
    alhazen.render(CORNELL, spp=4, width=20, height=20, progress=True)
    assert "100.0 %" in capfd.readouterr().err
    alhazen.render(CORNELL, spp=4, width=20, height=20, progress=False)
    assert capfd.readouterr().err == ""


def test_the_bar_in_a_notebook(monkeypatch):
    shown = []

    class Handle:
        def update(self, data, raw):
            shown.append(data)

    def display(data, raw, display_id):
        shown.append(data)
        return Handle()

    ipython = types.ModuleType("IPython")
    ipython.get_ipython = lambda: types.SimpleNamespace(kernel=object())
    ipython.display = types.ModuleType("IPython.display")
    ipython.display.display = display
    monkeypatch.setitem(sys.modules, "IPython", ipython)
    monkeypatch.setitem(sys.modules, "IPython.display", ipython.display)
    bar = alhazen.ProgressBar("a <b>")
    bar(progress(0.5, 1))
    bar(progress(1, 2))
    assert len(shown) == 2 and 'value="0.5000"' in shown[0]["text/html"] and "a &lt;b&gt;" in shown[0]["text/html"]
    assert "50.0 %" in shown[0]["text/plain"] and 'value="1.0000"' in shown[1]["text/html"]


def test_a_real_notebook_shows_the_bar_and_the_image(tmp_path):
    pytest.importorskip("nbconvert")
    pytest.importorskip("ipykernel")
    notebook = tmp_path / "bar.ipynb"
    code = f"import alhazen\nalhazen.render({str(CORNELL)!r}, spp=4, width=20, height=20, progress=True)"
    cell = {"cell_type": "code", "execution_count": None, "id": "a", "metadata": {}, "outputs": [], "source": code}
    kernel = {"kernelspec": {"name": "python3", "display_name": "python3", "language": "python"}}
    notebook.write_text(json.dumps({"cells": [cell], "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}))
    command = [sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--inplace", notebook]
    converted = subprocess.run(command, capture_output=True, text=True, timeout=120)
    if "No such kernel" in converted.stderr:
        pytest.skip("there is no kernel python3")
    assert converted.returncode == 0, converted.stderr
    outputs = json.loads(notebook.read_text())["cells"][0]["outputs"]
    data = [output["data"] for output in outputs if "data" in output]
    assert any("image/png" in each for each in data)
    assert any("100.0 %" in "".join(each.get("text/html", "")) for each in data)
