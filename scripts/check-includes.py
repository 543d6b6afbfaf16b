#!/usr/bin/env python3
"""Checks the rules of which layer may include which. Prints file:line for each violation and fails.

Layers are the folders of src/, and `alhazen` the public headers in include/. A file may include what its own layer
may, given below, by a path that starts at src/ or include/.
"""

import re
import sys
from pathlib import Path

BELOW_IO = {"geometry", "images", "colour", "files", "scene", "util", "core"}
BELOW_PIPELINE = BELOW_IO | {"io", "render", "alhazen"}
BELOW_STUDY = BELOW_PIPELINE | {"compile", "backends", "pipeline"}

MAY_INCLUDE = {
    "core": {"core"},
    "util": {"util", "core"},
    "scene": {"scene", "util", "core"},
    "files": {"files", "util"},
    "colour": {"colour", "files", "util", "core"},
    "images": {"images", "colour", "files", "scene", "util", "core"},
    "geometry": {"geometry", "scene", "util", "core"},
    "io": {"io"} | BELOW_IO,
    "compile": {"compile", "scene", "util", "core"},
    "render": {"render", "compile", "images", "files", "scene", "util", "core", "alhazen"},
    "queries": {"queries", "render", "compile", "scene", "util", "core", "alhazen"},
    "backends": {"backends", "render", "compile", "scene", "util", "core"},
    "pipeline": {"pipeline"} | BELOW_PIPELINE,
    "study": {"study"} | BELOW_STUDY,
    "api": {"api", "queries", "study"} | BELOW_STUDY,
    "view": {"view", "api", "pipeline", "render", "images", "files", "util", "alhazen"},
    "cli": {"cli", "view", "study"} | BELOW_STUDY - {"core"},
    "alhazen": {"alhazen"},
}

# Exceptions: (layer, path that it may include nevertheless, reason).
EXCEPTIONS = [
    ("core", "immintrin.h", "intrinsics of x86, within core/simd/lanes.h"),
    ("util", "alhazen/error.h", "the bases of what it throws"),
    ("util", "alhazen/warning.h", "what its warnings become"),
    ("util", "alhazen/log.h", "what it implements"),
]

# The core runs on devices too: of the standard library it may use only headers that need no run time support there.
CORE_STANDARD_HEADERS = {"bit", "cfloat", "cmath", "concepts", "cstddef", "cstdint", "limits", "type_traits"}

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]*)"|<([^>]*)>)')


def breaches(path, layer):
    allowed_paths = {included for by, included, _ in EXCEPTIONS if by == layer}
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        own, system = match.groups()
        if own is not None:
            target = own.split("/")[0]
            if target not in MAY_INCLUDE:
                yield number, f'"{own}" must be a path from src/ or include/'
            elif target not in MAY_INCLUDE[layer] and own not in allowed_paths:
                may = ", ".join(sorted(MAY_INCLUDE[layer])) or "nothing of the project"
                yield number, f'{layer} may not include "{own}", only {may}'
        elif system.split("/")[0] in MAY_INCLUDE:
            yield number, f'<{system}> is a file of the project: include it as "{system}"'
        elif layer == "core" and system not in CORE_STANDARD_HEADERS | allowed_paths:
            yield number, f"core may not include <{system}>, only {', '.join(sorted(CORE_STANDARD_HEADERS))}"


def main():
    root = Path(__file__).resolve().parent.parent
    files = [path for folder in ("src", "include") for path in sorted((root / folder).rglob("*"))
             if path.suffix in {".h", ".cpp", ".cu", ".cuh"}]
    failures = 0
    for path in files:
        name = path.relative_to(root)
        layer = name.parts[1]
        if layer not in MAY_INCLUDE:
            print(f"{name}:1: '{layer}' is not a layer known to {Path(__file__).name}: add it to its table")
            failures += 1
            continue
        for number, message in breaches(path, layer):
            print(f"{name}:{number}: {message}")
            failures += 1
    print(f"{len(files)} files, {failures} includes against the rules")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
