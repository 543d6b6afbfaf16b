"""The scripts and the notebook of examples/python: each is run with little to do, and what it writes is checked."""

import json
import os
import re
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import alhazen
from common import ROOT, SCENES

EXAMPLES = ROOT / "examples" / "python"
MODULE = str(Path(alhazen.__file__).absolute().parents[1])


def run(folder, *command):
    environment = {**os.environ, "PYTHONPATH": MODULE, "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run([*map(str, command)], cwd=folder, env=environment, capture_output=True, text=True,
                          check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def run_example(folder, name, *arguments):
    pytest.importorskip("matplotlib")
    return run(folder, sys.executable, EXAMPLES / f"{name}.py", *arguments)


def test_turntable(tmp_path):
    printed = run_example(tmp_path, "turntable", "--frames", 3, "--samples", 4, "--size", "48x32")
    files = sorted((tmp_path / "turn").iterdir())
    assert [file.name for file in files] == ["000.png", "001.png", "002.png"]
    assert re.findall(r"BVH was (built|kept) in", printed) == ["built", "kept", "kept"]
    frames = [alhazen.read_image(file) for file in files]
    assert all(frame.shape == (32, 48, 3) and np.mean(frame) > 0.01 for frame in frames)
    assert alhazen.compare(frames[0], frames[1]).flip > 0.05


def decoded(segmentation):
    """The mask of run lengths, by columns, of which the first is of pixels outside."""
    values = np.arange(len(segmentation["counts"])) % 2 == 1
    return np.repeat(values, segmentation["counts"]).reshape(segmentation["size"], order="F")


def check_annotations(annotations, names, ids):
    assert sorted(each["category_id"] for each in annotations) == sorted(set(ids[ids > 0]))
    for each in annotations:
        mask = ids == each["category_id"]
        np.testing.assert_array_equal(decoded(each["segmentation"]), mask)
        x, y, width, height = each["bbox"]
        inside = mask[y:y + height, x:x + width]
        assert each["area"] == mask.sum() == inside.sum() > 0 and each["category_id"] in names
        assert inside[0].any() and inside[-1].any() and inside[:, 0].any() and inside[:, -1].any()


def check_camera(scene, picture, layers, names):
    """Middles of balls, which are known, and hits of rays are seen at the pixels where they should be. Returns how many
    balls are seen."""
    width, height = picture["width"], picture["height"]
    k, matrix = np.array(picture["intrinsics"]), np.array(picture["world_to_camera"])
    eye = np.linalg.inv(matrix)[:3, 3]

    def project(points):
        seen = (points @ matrix[:3, :3].T + matrix[:3, 3]) @ k.T
        return seen[..., :2] / seen[..., 2:], seen[..., 2]

    seen = 0
    for ball in (shape for shape in scene.shapes if shape.name.endswith("ball")):
        centre = ball.transform[:3, 3]
        (x, y), _ = project(centre)
        hit = scene.intersect(eye, centre - eye)
        if scene.shapes[int(hit.shape)].name == ball.name and 0 < x < width and 0 < y < height:
            assert names[layers["object"][int(y), int(x)]] == ball.name
            seen += 1

    ids = layers["object"].astype(int)
    patches = np.lib.stride_tricks.sliding_window_view(ids, (3, 3)).reshape(height - 2, width - 2, 9)
    y, x = np.argwhere((patches == patches[..., :1]).all(axis=-1) & (patches[..., 0] > 0))[::7].T + 1
    pixels = np.stack([x + 0.5, y + 0.5, np.ones(len(x))], axis=-1)
    directions = pixels @ np.linalg.inv(k).T @ matrix[:3, :3]
    hits = scene.intersect(eye, directions)
    # Lamps are seen from their front alone, while rays hit both sides.
    is_lamp = np.array([scene.shapes[shape].name.endswith("box") for shape in hits.shape])
    start = np.where(is_lamp[:, None], hits.position + 1e-3 * directions, eye)
    hits = scene.intersect(start, directions)
    assert len(x) > 50 and hits.hit.all()
    assert [scene.shapes[shape].name for shape in hits.shape] == [names[number] for number in ids[y, x]]
    position, z = project(hits.position)
    np.testing.assert_allclose(position, pixels[:, :2], atol=1e-3)
    assert np.median(abs(layers["depth"][y, x] / z - 1)) < 0.01
    assert np.median(np.sum(layers["normal"][y, x] * hits.shading_normal, axis=-1)) > 0.95
    return seen


def test_dataset(tmp_path):
    run_example(tmp_path, "dataset", "--count", 4, "--samples", 8, "--size", "80x60")
    folder = tmp_path / "dataset"
    coco = json.loads((folder / "annotations.json").read_text())
    names = {category["id"]: category["name"] for category in coco["categories"]}
    assert len(coco["images"]) == 4 and {"knot", "vase", "floor"} <= set(names.values())
    assert len({each["id"] for each in coco["annotations"]}) == len(coco["annotations"]) > 20
    scene, seen = alhazen.load(SCENES / "studio.glb"), 0
    for picture in coco["images"]:
        assert np.asarray(alhazen.read_image(folder / picture["file_name"])).shape == (60, 80, 3)
        layers = np.load(folder / picture["layers"])
        assert layers["depth"].shape == layers["object"].shape == (60, 80) and layers["normal"].shape == (60, 80, 3)
        check_annotations([each for each in coco["annotations"] if each["image_id"] == picture["id"]], names,
                          layers["object"])
        seen += check_camera(scene, picture, layers, names)
    assert seen >= 8


def test_roughness_sweep(tmp_path):
    printed = run_example(tmp_path, "roughness_sweep", "--steps", 2, "--samples", 4, "--size", 40)
    height, width, _ = np.asarray(alhazen.read_image(tmp_path / "roughness.png")).shape
    assert height > 3 * 40 and width > 2 * 40
    brightest = {(name, roughness): float(value) for name, roughness, value in
                 re.findall(r"(\w+), roughness ([\d.]+): brightest pixel ([\d.e+]+)", printed)}
    assert len(brightest) == 6
    for name in ("gold", "glass"):  # equal roughness gives equal bits
        assert brightest[name, "0.00"] != brightest[name, "0.75"] > 0


def test_plot_study(tmp_path):
    pytest.importorskip("matplotlib")
    from test_tools import study_json
    (tmp_path / "study.json").write_text(json.dumps(study_json()))
    printed = run_example(tmp_path, "plot_study", tmp_path)
    assert "Study of spheres.pbrt" in printed and re.search(r"2 static\s+float", printed)
    files = sorted(file.name for file in (tmp_path / "plots").iterdir())
    assert files == ["scaling.png", "speedups-table3.png"]
    assert all(np.std(alhazen.read_image(tmp_path / "plots" / file)) > 0.05 for file in files)


def test_ray_queries(tmp_path):
    printed = run_example(tmp_path, "ray_queries", "--size", "64x36", "--samples", 8)
    assert re.search(r"\d+% of the rays hit something", printed)
    depth, occlusion = (np.asarray(alhazen.read_image(tmp_path / f"rays-{name}.png"))[..., 0]
                        for name in ("depth", "occlusion"))
    scene = alhazen.load(SCENES / "studio.glb")
    expected = alhazen.render(scene, spp=16, size=(64, 36), layers=["depth"])["depth"]
    seen = (depth > 0) & (expected > 0)
    assert ((depth > 0) != (expected > 0)).mean() < 0.1  # that of the renderer reaches over edges
    assert np.corrcoef(np.sqrt(depth[seen]), 1 / expected[seen])[0, 1] > 0.95  # near is bright
    assert 0.5 < occlusion[depth > 0].mean() < 0.98 and occlusion.max() > 0.99

    camera_rays = runpy.run_path(str(EXAMPLES / "ray_queries.py"))["camera_rays"]
    hits = scene.intersect(*camera_rays(scene.camera, 64, 36), fields=())
    assert np.median(abs(hits.t[hits.hit] / expected[hits.hit] - 1)) < 0.01


def test_tour(tmp_path):
    converter = shutil.which("jupyter-nbconvert", path="/usr/bin") or shutil.which("jupyter-nbconvert")
    if converter is None:
        pytest.skip("jupyter-nbconvert is not installed (Debian: jupyter-nbconvert, python3-ipykernel)")
    notebook = json.loads((EXAMPLES / "tour.ipynb").read_text())
    assert all(not cell["outputs"] and cell["execution_count"] is None for cell in notebook["cells"]
               if cell["cell_type"] == "code")
    run(tmp_path, converter, "--to", "notebook", "--execute", "--output-dir", tmp_path, "--output", "done",
        EXAMPLES / "tour.ipynb")
    done = json.loads((tmp_path / "done.ipynb").read_text())
    shown = [output for cell in done["cells"] for output in cell.get("outputs", [])]
    assert sum("image/png" in output.get("data", {}) for output in shown) >= 5
    assert any("<progress" in "".join(output.get("data", {}).get("text/html", "")) for output in shown)
    assert not any(output["output_type"] == "error" for output in shown)
