"""What the tests have in common: scenes, the program, and processes of Python."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import alhazen

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes"
CORNELL = SCENES / "cornell.pbrt"
#: Renders for as long as one likes.
ENDLESS = dict(spp=1 << 20, width=200, height=200)


def program():
    """The program of the same build; tests that compare with it are skipped where it is not."""
    path = Path(os.environ.get("ALHAZEN_PROGRAM", Path(alhazen.__file__).absolute().parents[2] / "bin" / "alhazen"))
    if not path.exists():
        pytest.skip(f"there is no program at {path}; ALHAZEN_PROGRAM names it")
    return str(path)


def run_program(*arguments):
    environment = {**os.environ, "ALHAZEN_TUNED": ""}
    return subprocess.run([program(), *map(str, arguments)], check=True, capture_output=True, text=True,
                          env=environment).stdout


def start_python(code, *arguments, **options):
    """A process that runs the code, with the module to be tested."""
    folder = str(Path(alhazen.__file__).absolute().parents[1])
    environment = {**os.environ, "PYTHONPATH": folder}
    return subprocess.Popen([sys.executable, "-c", code, *map(str, arguments)], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, env=environment, **options)


def pixels_of_exr(path):
    return np.asarray(alhazen.read_image(path))
