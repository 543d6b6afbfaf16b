#!/usr/bin/env python3
"""Writes the type stubs of the Python module from its documentation: what type checkers and editors know of the extension.

usage: scripts/write-stubs.py FOLDER [OUTPUT] [--strict]

FOLDER has the package alhazen; OUTPUT, by default FOLDER/alhazen, gets _alhazen.pyi and __init__.pyi. The first line of a class or function is its signature, and what a property says begins with its
type; types are those of Python or the words of TYPES. What is not understood becomes Any; --strict makes it an error.
"""

import argparse
import importlib
import inspect
import re
import sys
import textwrap
from pathlib import Path

HEAD = '''\
# Written by scripts/write-stubs.py.

import os
from collections import abc
from types import TracebackType
from typing import Any, Generic, Literal, Protocol, TypeVar, overload

import numpy as np
import numpy.typing as npt

_Get = TypeVar("_Get")
_Set = TypeVar("_Set")

class _Attribute(Generic[_Get, _Set]):
    """An attribute that takes more than it gives back."""

    @overload
    def __get__(self, instance: None, owner: type) -> property: ...
    @overload
    def __get__(self, instance: object, owner: type) -> _Get: ...
    def __set__(self, instance: object, value: _Set) -> None: ...

class _MeshLike(Protocol):
    """An object of another library, as trimesh.Trimesh."""

    @property
    def vertices(self) -> Any: ...
    @property
    def faces(self) -> Any: ...

_Numbers = abc.Sequence[float] | npt.NDArray[Any]
_Matrix = abc.Sequence[abc.Sequence[float]] | npt.NDArray[Any]
_Path = str | bytes | os.PathLike[str] | os.PathLike[bytes]
'''

TRIPLE = "tuple[float, float, float]"
# Words of the documentation: what is taken, and what is given back where that differs.
TYPES = {
    "mesh-like": ("_MeshLike",),
    "color": ("float | _Numbers", TRIPLE),
    "number": ("float",),
    "array": ("npt.ArrayLike", "npt.NDArray[Any]"),
    "path": ("_Path", "str"),
    "object": ("Any",), "handle": ("Any",), "Any": ("Any",),
    "tuple": ("tuple[Any, ...]",), "list": ("list[Any]",), "dict": ("dict[str, Any]",), "set": ("set[Any]",),
    "Callable": ("abc.Callable[..., Any]",), "callable": ("abc.Callable[..., Any]",), "function": ("abc.Callable[..., Any]",),
    "numpy.ndarray": ("npt.NDArray[Any]",), "ndarray": ("npt.NDArray[Any]",), "buffer": ("bytes | bytearray | memoryview",),
    "iterable": ("abc.Iterable[Any]",), "Iterator": ("abc.Iterator[Any]",), "Iterable": ("abc.Iterable[Any]",),
    "sequence": ("abc.Sequence[Any]",), "Sequence": ("abc.Sequence[Any]",),
    "os.PathLike": ("os.PathLike[str]",), "PathLike": ("os.PathLike[str]",),
}
BUILTINS = {"int", "float", "str", "bool", "bytes", "None", "complex", "type", "bytearray", "memoryview"}
GENERICS = {"list": "list", "List": "list", "dict": "dict", "Dict": "dict", "tuple": "tuple", "Tuple": "tuple", "set": "set",
            "Set": "set", "Callable": "abc.Callable", "Iterator": "abc.Iterator", "Iterable": "abc.Iterable", "Sequence": "abc.Sequence",
            "Mapping": "abc.Mapping", "type": "type"}
# Attributes whose documentation begins with no type: what they give back, and what they take where that differs.
ATTRIBUTES = {
    "Transform.matrix": ("4x4 array",), "MovingTransform.start": ("4x4 array",), "MovingTransform.end": ("4x4 array",),
    "Box.low": ("3 numbers",), "Box.high": ("3 numbers",), "Box.center": ("3 numbers",), "Box.extents": ("3 numbers",),
    "Box.is_empty": ("bool",), "Image.pixels": ("array | None",), "Image.file": ("str | None",),
    "Image.encoding": ("str | None",), "SceneImage.encoding": ("str",), "SceneImage.pixels": ("array", "array | Image"),
    "SceneMesh.vertices": ("array of float64",), "Scene.warnings": ("list[str]",), "Scene.file": ("str | None",),
    "Scene.bounds": ("Box",), "Scene.up": ("3 numbers",), "Scene.environment": ("SceneLight | None", "object"),
    "Scene.camera": ("SceneCamera", "SceneCamera | Camera"), "Scene.film": ("SceneFilm", "SceneFilm | Film"),
    "Scene.pixel_filter": ("ScenePixelFilter", "ScenePixelFilter | PixelFilter"),
    "Scene.defaults": ("SceneDefaults", "SceneDefaults | RenderDefaults"), "SceneLight.image": ("array | None", "object"),
    "SceneShape.geometry": ("SceneMesh | Sphere | Cylinder | Disk", "SceneMesh | Mesh | Sphere | Cylinder | Disk"), "SceneShape.material": ("SceneMaterial | None", "object"),
    "SceneShape.emission": ("Emission | None", "object"), "SceneShape.group": ("SceneGroup | None",),
    "SceneInstance.group": ("SceneGroup",), "SceneGroup.shapes": ("list[SceneShape]",), "Live.value": ("object",),
    "*.is_moving": ("bool",), "*.scene": ("Scene",), "*.end_transform": ("4x4 array", "4x4 array | Transform"),
    "*.transform": ("4x4 array", "4x4 array | Transform | MovingTransform"),
    **{f"Scene.{kind.lower()}{'es' if kind == 'Mesh' else 's'}": (f"Scene{kind}List",)
       for kind in ("Mesh", "Image", "Texture", "Material", "Shape", "Group", "Instance", "Light")},
}
PLACED = "*, transform: object = None, reverse_orientation: bool = False, name: str = ''"
SHAPED = "*, material: object = None, transform: object = None, emission: object = None, reverse_orientation: bool = False, name: str = ''"
# Functions that give back what follows from what they take.
OVERLOADS = {
    "Scene.add": ["add(what: SceneGroup, " + PLACED + ") -> SceneInstance",
                  "add(what: Light, *, image: array | Image | path | None = None) -> SceneLight",
                  "add(what: Material) -> SceneMaterial", "add(what: Texture) -> SceneTexture", "add(what: Image) -> SceneImage",
                  "add(what: Mesh | SceneMesh | Sphere | Cylinder | Disk | mesh-like, " + SHAPED + ") -> SceneShape"],
}
COUNTS = {"two": 2, "three": 3, "four": 4}
# What operators take and give is what Python says of them.
OPERATORS = {
    "__repr__": "(self) -> str", "__str__": "(self) -> str", "__len__": "(self) -> int", "__bool__": "(self) -> bool",
    "__hash__": "(self) -> int", "__eq__": "(self, other: object) -> bool", "__ne__": "(self, other: object) -> bool",
    "__copy__": "(self) -> {self}", "__deepcopy__": "(self, memo: Any) -> {self}", "__int__": "(self) -> int",
    "__enter__": "(self) -> {self}", "__contains__": "(self, item: object) -> bool",
    "__exit__": "(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None",
    "__matmul__": "(self, other: {self} | _Matrix) -> {self}", "__rmatmul__": "(self, other: {self} | _Matrix) -> {self}",
    "__array__": "(self, dtype: npt.DTypeLike = ..., copy: bool | None = ...) -> npt.NDArray[Any]",
    "__iter__": "(self) -> abc.Iterator[{item}]", "__reversed__": "(self) -> abc.Iterator[{item}]",
    "__getattr__": "(self, name: str) -> Any", "__setattr__": "(self, name: str, value: Any) -> None", "__delattr__": None, "__getstate__": None, "__setstate__": None,
    "__dir__": None, "__reduce__": None, "__reduce_ex__": None,
}


class Unknown(Exception):
    pass


def split(text, separator):
    """At separators outside of brackets and quotes."""
    depth, quote, part, parts = 0, "", "", []
    for character in text:
        if quote:
            quote = "" if character == quote else quote
        elif character in "'\"":
            quote = character
        else:
            # The arrow of a type Callable is no bracket.
            depth += (character in "([{<") - (character in ")]}" or (character == ">" and not part.endswith("-")))
            if character == separator and depth == 0:
                parts.append(part.strip())
                part = ""
                continue
        part += character
    return [*parts, part.strip()] if part.strip() or parts else []


class Types:
    """Translates the types of the documentation of one module."""

    def __init__(self, module):
        self.names = {name for name in vars(module) if not name.startswith("_")}

    def one(self, text, given):
        """`given`: the type of an argument; otherwise of what is returned."""
        text = text.strip().removeprefix("alhazen.").removeprefix("_alhazen.")
        if text in BUILTINS or text in self.names:
            return text
        if text in TYPES:
            return TYPES[text][0 if given else -1]
        if match := re.fullmatch(r"(?:tuple of )?(\d+|two|three|four) numbers|tuple of (\d+)", text):
            count = COUNTS.get(match[1]) or int(match[1] or match[2])
            return "_Numbers" if given else f"tuple[{', '.join(['float'] * count)}]"
        if re.fullmatch(r"\d+x\d+ (array|matrix)|array of (the )?shape \(\d+, \d+\)( or \(\d+, \d+\))?", text):
            if not given:
                return "npt.NDArray[np.float64]"
            return "_Matrix | Transform" if "Transform" in self.names and "4" in text else "_Matrix"
        if match := re.fullmatch(r"(?:read-only )?(?:(?:\([^()]*\) or )?\([^()]*\) )?array(?: of (?:the shape \([^()]*\)|(u?int\d+|float\d+)(?: or float\d+)?))?", text):
            if match[1] and not given:
                return f"npt.NDArray[np.{match[1]}]"
            return TYPES["array"][0 if given else -1]
        if match := re.match(r"(?:numpy\.)?ndarray\[(?:numpy\.|np\.)?(\w+)", text):
            return f"npt.NDArray[np.{match[1]}]"
        if match := re.fullmatch(r"(?:typing\.)?(\w+)\[(.*)\]", text):
            inner = split(match[2], ",")
            if match[1] == "Optional":
                return self.union(match[2], given) + " | None"
            if match[1] == "Union":
                return " | ".join(self.union(part, given) for part in inner)
            if match[1] == "Literal":
                return text
            if match[1] == "Callable" and len(inner) == 2:
                arguments = split(inner[0].strip("[]"), ",") if inner[0] != "..." else None
                listed = "..." if arguments is None else f"[{', '.join(self.union(a, not given) for a in arguments)}]"
                return f"abc.Callable[{listed}, {self.union(inner[1], given)}]"
            if given and match[1] in ("tuple", "Tuple") and len(inner) > 1 and set(inner) == {"float"}:
                return "_Numbers"
            if match[1] in GENERICS:
                return f"{GENERICS[match[1]]}[{', '.join('...' if a == '...' else self.union(a, given) for a in inner)}]"
        names = re.findall(r"'[^']*'", text)
        if names and not re.sub(r"'[^']*'|one of|and|or|,|\s", "", text):
            return f"Literal[{', '.join(names)}]"
        raise Unknown(text)

    def know(self, text):
        try:
            return bool(text) and text != "object" and bool(self.union(text, True))
        except Unknown:
            return False

    def union(self, text, given):
        """Of 'a | b', each type once."""
        parts = [part for piece in split(text, "|") for part in split(self.one(piece, given), "|")]
        return " | ".join(dict.fromkeys(parts))


class Writer:
    def __init__(self, module):
        self.module = module
        self.types = Types(module)
        self.lines = []
        self.problems = []

    def problem(self, place, what):
        if not place.startswith("_"):
            self.problems.append(f"{place}: {what}")

    def type(self, text, given, place):
        try:
            return self.types.union(text, given)
        except Unknown as unknown:
            self.problem(place, f"the type '{unknown}' is not known")
            return "Any"

    def signature(self, line, name, place, with_self):
        """'name(a: float = 1, *, b) -> T' as it stands in a stub, or None."""
        match = re.match(rf"(?:\d+\. )?{re.escape(name)}(\(.*)", line)
        if not match:
            return None
        text, depth = match[1], 0
        end = 0
        quote = ""
        for end, character in enumerate(text):
            if quote:
                quote = "" if character == quote else quote
            elif character in "'\"":
                quote = character
            else:
                depth += (character in "([{") - (character in ")]}")
                if depth == 0:
                    break
        parameters = []
        for part in split(text[1:end], ","):
            if part in ("*", "/"):
                parameters.append(part)
                continue
            found = re.match(r"(\*{0,2}\w+)(?:\s*:\s*(.*))?$", split(part, "=")[0])
            if not found:
                self.problem(place, f"the argument '{part}' is not understood")
                return None
            if found[1] == "self":
                continue
            kind = found[2]
            written = f"{found[1]}: {self.type(kind, True, f'{place}({found[1]})') if kind else 'Any'}"
            if len(split(part, "=")) > 1:
                written += " = ..."
            parameters.append(written)
        returned = re.match(r"\s*->\s*(.*?)\.?$", text[end + 1:])
        result = "None" if name == "__init__" else self.type(returned[1], False, place) if returned else "None"
        return f"({', '.join((['self'] if with_self else []) + parameters)}) -> {result}"

    def add(self, indent, text, doc=""):
        self.lines.append(" " * indent + text)
        doc = textwrap.dedent(doc).strip().replace("\\", "\\\\").replace('"""', "'''")
        if doc:
            quoted = f'"""{doc}"""' if "\n" not in doc and not doc.endswith('"') else f'"""{doc}\n"""'
            self.lines += [" " * (indent + 4) + line if line else "" for line in quoted.splitlines()]
            if not text.startswith("class "):
                self.lines.append(" " * (indent + 4) + "...")

    def function(self, name, value, indent, owner="", decorator=""):
        place = f"{owner}.{name}" if owner else name
        doc = inspect.getdoc(value) or ""
        with_self = bool(owner) and decorator != "@staticmethod"
        if name in OPERATORS:
            # Those of values are for other spellings alone.
            if OPERATORS[name] and not (owner == "Value" and name.endswith("attr__")):
                item = owner.removesuffix("List") if owner.endswith("List") else "Any"
                self.add(indent, f"def {name}{OPERATORS[name].format(self=owner, item=item)}: ...")
            return
        if name == "__init__" and (not doc or doc.startswith("Initialize self.")):
            return  # the class has no constructor
        overloaded = doc.startswith(f"{name}(*args, **kwargs)\nOverloaded function.")
        lines = re.findall(rf"^\d+\. ({re.escape(name)}\(.*)$", doc, re.MULTILINE) if overloaded else doc.splitlines()[:1]
        lines = OVERLOADS.get(place, lines)
        found = [self.signature(line, name, place, with_self) for line in lines]
        if not found or None in found:
            self.problem(place, "its documentation does not begin with a signature")
            found = [f"({'self, ' if with_self else ''}*args: Any, **kwargs: Any) -> Any"]
        rest = "" if overloaded else "\n".join(doc.splitlines()[1:])
        for text in found:
            if len(found) > 1:
                self.add(indent, "@overload")
            if decorator:
                self.add(indent, decorator)
            self.add(indent, f"def {name}{text}:" + ("" if rest.strip() else " ..."), rest)

    def attribute(self, name, value, owner):
        place = f"{owner}.{name}"
        doc = (value.__doc__ or getattr(value.fget, "__doc__", None) or "").strip()
        returned = re.match(rf"(?:{name})?\(self.*?\) -> (.*)", doc.splitlines()[0] if doc else "")
        words = returned[1] if returned else split(doc.split("\n\n")[0].replace("\n", " "), ":")[0].rstrip(".") if doc else ""
        words = taken_words = words.replace(", or None", " | None")
        if not self.types.know(words):
            found = ATTRIBUTES.get(place) or ATTRIBUTES.get(f"*.{name}")
            if not found:
                self.problem(place, "its documentation does not begin with a type")
            words, taken_words = (found[0], found[-1]) if found else ("object", "object")
        given, taken = self.type(words, False, place), self.type(taken_words, True, place)
        text = doc[len(words) + 1:].strip() if not returned and doc.startswith(words) else ""
        if value.fset and given != taken:
            self.add(4, f"{name}: _Attribute[{given}, {taken}]")
            if text:
                self.lines.append(f"    {text.splitlines()[0]!r}")
            return
        self.add(4, "@property")
        self.add(4, f"def {name}(self) -> {given}:" + ("" if text else " ..."), text)
        if value.fset:
            self.add(4, f"@{name}.setter")
            self.add(4, f"def {name}(self, value: {taken}) -> None: ...")

    def a_class(self, name, value):
        bases = [base.__name__ for base in value.__bases__ if base.__module__ in ("builtins", "alhazen") and base is not object]
        doc = inspect.getdoc(value) or ""
        first = doc.splitlines()[0] if doc else ""
        own = self.signature(first, name, name, True) if first.startswith(f"{name}(") else None
        self.lines.append("")
        head = f"class {name}{'(' + ', '.join(bases) + ')' if bases else ''}:"
        self.add(0, head, "\n".join(doc.splitlines()[1:]) if own else doc)
        start = len(self.lines)
        for member, thing in vars(value).items():
            if isinstance(thing, property):
                self.attribute(member, thing, name)
            elif isinstance(thing, staticmethod):
                self.function(member, thing.__func__, 4, name, "@staticmethod")
            elif member == "__init__" and own:
                self.add(4, f"def __init__{own[:own.rindex(' -> ')]} -> None: ...")
            elif member == "__hash__" and thing is None:
                self.add(4, "__hash__: None  # type: ignore[assignment]")
            elif member.startswith("__") and thing is None and member != "__doc__":
                self.add(4, f"{member}: None")  # what others of its kind have, and this has not
            elif callable(thing) and (not member.startswith("__") or member in OPERATORS or member.startswith("__init__") or
                                      member in ("__getitem__", "__next__")):
                if issubclass(value, BaseException):
                    continue
                self.function(member, thing, 4, name)
            elif issubclass(value, BaseException) and not member.startswith("_") and thing is None:
                self.add(4, f"{member}: {'int' if member in ('line', 'column') else 'str'} | None")
            elif not member.startswith("_"):
                self.problem(f"{name}.{member}", f"a {type(thing).__name__} is not understood")
                self.add(4, f"{member}: Any")
        if len(self.lines) == start and '"""' not in self.lines[-1]:
            self.lines[-1] += " ..."

    def write(self):
        for name, value in vars(self.module).items():
            if name.startswith("__"):
                continue
            if isinstance(value, type):
                if value.__name__ != name:
                    self.lines += ["", f"{name} = {value.__name__}"]
                else:
                    self.a_class(name, value)
            elif callable(value):
                self.lines.append("")
                self.function(name, value, 0)
            else:
                self.lines += ["", f"{name}: {type(value).__name__}"]
        self.lines += ["", "__version__: str"]
        return HEAD + "\n".join(self.lines) + "\n"


def package_stub(package, extension, problems):
    """That of the package: it lists the names of its __all__, and where each is from."""
    lines = ["# Written by scripts/write-stubs.py.", ""]
    for name in package.__all__:
        value = getattr(package, name)
        module = getattr(value, "__module__", "") or ""
        if inspect.ismodule(value):
            lines.append(f"from . import {name} as {name}")
        elif name in vars(extension):
            lines.append(f"from ._alhazen import {name} as {name}")
        elif module.startswith("alhazen."):
            lines.append(f"from {module.removeprefix('alhazen')} import {name} as {name}")
        else:
            problems.append(f"{name}: it is defined in __init__.py, not in a file of its own")
            lines += ["from typing import Any", f"{name}: Any"]
    quoted = ", ".join(f'"{name}"' for name in package.__all__)
    return "\n".join([*lines, "", *textwrap.wrap(f"__all__ = [{quoted}]", 120)]) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("output", type=Path, nargs="?")
    parser.add_argument("--strict", action="store_true")
    options = parser.parse_args()
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(options.folder))
    extension = importlib.import_module("alhazen._alhazen")
    writer = Writer(extension)
    output = options.output or options.folder / "alhazen"
    (output / "_alhazen.pyi").write_text(writer.write(), encoding="utf-8")
    package = package_stub(importlib.import_module("alhazen"), extension, writer.problems)
    (output / "__init__.pyi").write_text(package, encoding="utf-8")
    for problem in dict.fromkeys(writer.problems) if options.strict else []:
        print(f"write-stubs: {problem}", file=sys.stderr)
    sys.exit(1 if options.strict and writer.problems else 0)


if __name__ == "__main__":
    main()
