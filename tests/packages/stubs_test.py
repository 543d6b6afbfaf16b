"""The type stubs of the Python module: they have every public name and no others, no type in them is unknown, and what is written
in Python uses the module by these types.

usage: stubs_test.py SOURCE BUILD; ends with 77, skipped, where mypy is missing
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

if not find_spec("mypy"):
    print("mypy is not installed (Debian: mypy): the stubs are not checked")
    sys.exit(77)

SOURCE, BUILD = (Path(name).resolve() for name in sys.argv[1:3])
BUILT = BUILD / "python"


def run(*arguments, stubs=BUILT):
    environment = {**os.environ, "PYTHONPATH": str(BUILT), "MYPYPATH": str(stubs), "PYTHONDONTWRITEBYTECODE": "1"}
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([sys.executable, *map(str, arguments)], env=environment, cwd=folder, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def expect_success(*arguments):
    status, text = run(*arguments)
    if status != 0:
        sys.exit(f"stubs_test: {' '.join(map(str, arguments))}\n{text}")


def mypy(*arguments):
    return "-m", "mypy", "--config-file", SOURCE / "pyproject.toml", "--cache-dir", os.devnull, *arguments


def stubtest(stubs=BUILT):
    return run("-m", "mypy.stubtest", "alhazen", "--concise", "--mypy-config-file", SOURCE / "pyproject.toml", stubs=stubs)[1]


def check_stubtest():
    text = stubtest()
    # What pybind11 gives to its classes: a metaclass, and an __init__ that refuses all to those without a constructor.
    expected = ("is inconsistent, metaclass differs", '__init__ is inconsistent, stub does not have *args argument "args"')
    # Files of Python are no stubs of themselves.
    written = "|".join(path.stem for path in (BUILT / "alhazen").glob("*.py") if path.stem != "__init__")
    faults = [line for line in text.splitlines()
              if line and not line.endswith(expected) and not re.match(rf"alhazen\.({written})\.", line)]
    if faults:
        sys.exit("stubs_test: stubtest\n" + "\n".join(faults))


def check_faults_are_found():
    """A stub that lacks a name and has another one instead is refused."""
    with tempfile.TemporaryDirectory() as folder:
        stubs = Path(folder) / "alhazen"
        shutil.copytree(BUILT / "alhazen", stubs, ignore=shutil.ignore_patterns("*.so"))
        text = (stubs / "_alhazen.pyi").read_text(encoding="utf-8")
        name = re.search(r"^def (\w+)", text, re.MULTILINE)[1]
        for path in stubs.glob("*.pyi"):
            path.write_text(re.sub(rf"\b{name}\b", "no_such_function", path.read_text(encoding="utf-8")), encoding="utf-8")
        text = stubtest(folder)
        for fault in ("no_such_function is not present at runtime", f"alhazen.{name} is not present in stub"):
            assert fault in text, text


GOOD = """
import alhazen
import numpy as np

scene = alhazen.Scene()
clay = alhazen.Principled(base_color=(0.8, 0.2, 0.1), roughness=0.4)
clay.base_color = 0.5
clay.base_color = np.ones(3)
scene.add(clay)
scene.camera = alhazen.Camera(transform=alhazen.Transform.look_at((0, 1, 4), (0, 0, 0)))
image: alhazen.RenderedImage = alhazen.render(scene, spp=4)
depth: np.ndarray = image.layer("depth")
"""
BAD = {"clay.roughness = b'rough'": "Incompatible types in assignment",
       "alhazen.Principled(no_such_argument=1)": 'Unexpected keyword argument "no_such_argument"',
       "alhazen.Transform.translate('up')": 'Argument 1 to "translate" of "Transform" has incompatible type "str"',
       "scene.no_such_method()": '"Scene" has no attribute "no_such_method"',
       "alhazen.no_such_function()": 'Module has no attribute "no_such_function"'}


def check_uses():
    with tempfile.TemporaryDirectory() as folder:
        good, bad = Path(folder) / "good.py", Path(folder) / "bad.py"
        good.write_text(GOOD)
        expect_success(*mypy(good))
        bad.write_text(GOOD + "".join(f"{line}\n" for line in BAD))
        _, text = run(*mypy(bad))
        for fault in BAD.values():
            assert fault in text, text
        assert text.count(": error:") == len(BAD), text


with tempfile.TemporaryDirectory() as folder:
    expect_success(SOURCE / "scripts/write-stubs.py", BUILT, folder, "--strict")
check_stubtest()
check_faults_are_found()
check_uses()
expect_success(*mypy("-p", "alhazen"))
examples = sorted((SOURCE / "examples/python").glob("*.py"))
for example in examples:
    expect_success(*mypy(example))
print(f"the stubs have what the module has; the package and {len(examples)} examples are used by its types")
