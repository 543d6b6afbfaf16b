"""The stubs of the Python module: every public name of the module and no others, with the same arguments; and what is written in
Python uses it by these types.

usage: stubs_test.py SOURCE BUILD; ends with 77, skipped, where mypy is missing
"""

import ast
import os
import re
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

if not find_spec("mypy"):
    print("mypy is not installed (Debian: mypy): the stubs are not checked")
    sys.exit(77)

SOURCE, BUILD = (Path(name).resolve() for name in sys.argv[1:3])
sys.path.insert(0, str(BUILD / "python"))
import alhazen  # noqa: E402


def run(module, *arguments, stubs):
    environment = {**os.environ, "PYTHONPATH": str(BUILD / "python"), "MYPYPATH": str(stubs), "PYTHONDONTWRITEBYTECODE": "1"}
    with tempfile.TemporaryDirectory() as folder:
        return subprocess.run([sys.executable, "-m", module, *map(str, arguments)], env=environment, cwd=folder,
                              capture_output=True, text=True)


def stubtest(stubs):
    return run("mypy.stubtest", "alhazen", "--mypy-config-file", SOURCE / "pyproject.toml", stubs=stubs)


def check_names():
    done = stubtest(SOURCE / "python")
    assert done.returncode == 0, done.stdout + done.stderr


def check_faults_are_found():
    """A stub that has one name too many, and one that lacks one, are faults."""
    with tempfile.TemporaryDirectory() as folder:
        stubs = Path(folder) / "alhazen"
        stubs.mkdir()
        for path in (SOURCE / "python/alhazen").glob("*.pyi"):
            text = path.read_text(encoding="utf-8")
            if path.name == "_alhazen.pyi":
                assert "def version(" in text
                text = text.replace("def version(", "def no_such_function(")
            (stubs / path.name).write_text(text, encoding="utf-8")
        (stubs / "py.typed").touch()
        done = stubtest(folder)
        for fault in ("no_such_function is not present at runtime", "version is not present in stub"):
            assert fault in done.stdout, done.stdout + done.stderr


def arguments_of_stub(function):
    names = [a.arg for a in function.args.posonlyargs + function.args.args]
    stars = (["*" + function.args.vararg.arg] if function.args.vararg else ["*"] if function.args.kwonlyargs else [])
    last = ["**" + function.args.kwarg.arg] if function.args.kwarg else []
    return names + stars + [a.arg for a in function.args.kwonlyargs] + last


def signatures_of_runtime(doc, name):
    """What pybind11 writes on top of the documentation, with one line for each overload: names of arguments."""
    for line in re.findall(rf"^(?:\d+\. )?{name}\((.*)\)(?: -> .*)?$", doc or "", re.MULTILINE):
        depth, part, parts = 0, "", []
        for character in line:
            depth += (character in "([{<") - (character in ")]}>")
            if character == "," and depth == 0:
                parts.append(part)
                part = ""
            else:
                part += character
        names = [re.match(r"\s*(\*{0,2}\w*)", text)[1] for text in [*parts, part] if text.strip()]
        if names != ["*args", "**kwargs"]:  # how pybind11 announces that overloads follow
            yield names


def check_arguments():
    tree = ast.parse((SOURCE / "python/alhazen/_alhazen.pyi").read_text(encoding="utf-8"))
    compared = 0

    def check(owner, body, place):
        nonlocal compared
        declared = {}
        for node in body:
            if isinstance(node, ast.ClassDef):
                check(getattr(owner, node.name), node.body, f"{place}.{node.name}")
            elif isinstance(node, ast.FunctionDef) and not any(
                    isinstance(d, ast.Attribute) or getattr(d, "id", "") == "property" for d in node.decorator_list):
                declared.setdefault(node.name, []).append(arguments_of_stub(node))
        for name, signatures in declared.items():
            found = list(signatures_of_runtime(getattr(getattr(owner, name), "__doc__", ""), name))
            if not found or name.startswith("__") and name != "__init__":
                continue  # operators have no names of arguments that anyone could use
            compared += 1
            found = [["self" if i == 0 and arguments[0] == "self" else a for i, a in enumerate(arguments)] for arguments in found]
            assert sorted(found) == sorted(signatures), f"{place}.{name}: the module has {found}, the stub {signatures}"

    check(alhazen._alhazen, tree.body, "alhazen")
    assert compared > 0
    return compared


def check_users():
    """Examples, and the files of the package itself."""
    files = sorted([*(SOURCE / "python/alhazen").glob("*.py"), *(SOURCE / "examples/python").glob("*.py")])
    done = run("mypy", "--config-file", SOURCE / "pyproject.toml", "--cache-dir", "/dev/null", *files, stubs=SOURCE / "python")
    assert done.returncode == 0, done.stdout + done.stderr
    return len(files)


check_names()
check_faults_are_found()
print(f"the arguments of {check_arguments()} functions and methods are those of the module; mypy checked {check_users()} files")
