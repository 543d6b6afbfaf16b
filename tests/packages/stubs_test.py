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


def check_stubtest():
    _, text = run("-m", "mypy.stubtest", "alhazen", "--concise", "--mypy-config-file", SOURCE / "pyproject.toml")
    # The metaclass that pybind11 gives to its classes is of no concern to those who use them.
    faults = [line for line in text.splitlines() if line and not line.endswith("is inconsistent, metaclass differs")]
    if faults:
        sys.exit("stubs_test: stubtest\n" + "\n".join(faults))


def check_faults_are_found():
    """A stub that lacks a name and has another one instead is refused, and so is a use of what is not there."""
    with tempfile.TemporaryDirectory() as folder:
        stubs = Path(folder) / "alhazen"
        shutil.copytree(BUILT / "alhazen", stubs, ignore=shutil.ignore_patterns("*.so"))
        text = (stubs / "_alhazen.pyi").read_text(encoding="utf-8")
        name = re.search(r"^def (\w+)", text, re.MULTILINE)[1]
        for path in stubs.glob("*.pyi"):
            path.write_text(re.sub(rf"\b{name}\b", "no_such_function", path.read_text(encoding="utf-8")), encoding="utf-8")
        _, text = run("-m", "mypy.stubtest", "alhazen", stubs=folder)
        for fault in ("no_such_function is not present at runtime", f"alhazen.{name} is not present in stub"):
            assert fault in text, text
        use = Path(folder) / "use.py"
        use.write_text("import alhazen\nalhazen.Scene().no_such_method()\nalhazen.no_such_function()\n")
        _, text = run(*mypy(use))
        for fault in ('"Scene" has no attribute "no_such_method"', 'Module has no attribute "no_such_function"'):
            assert fault in text, text


with tempfile.TemporaryDirectory() as folder:
    expect_success(SOURCE / "scripts/write-stubs.py", BUILT, folder, "--strict")
check_stubtest()
check_faults_are_found()
expect_success(*mypy("-p", "alhazen"))
examples = sorted((SOURCE / "examples/python").glob("*.py"))
for example in examples:
    expect_success(*mypy(example))
print(f"the stubs have what the module has; the package and {len(examples)} examples are used by its types")
