"""Alhazen, a path tracer: scenes from arrays or files, rendered into NumPy arrays."""

import importlib.machinery as _machinery
import importlib.util as _util
import pathlib as _pathlib
import sys as _sys

if _util.find_spec("numpy") is None:
    raise ImportError(f"alhazen needs NumPy, which {_sys.executable} does not find (Debian: python3-numpy)")
_built = [_path.name for _path in _pathlib.Path(__file__).parent.glob("_alhazen.*.so")]
if _built and not any(f"_alhazen{_suffix}" in _built for _suffix in _machinery.EXTENSION_SUFFIXES):
    raise ImportError(f"alhazen is built for another Python ({', '.join(_built)}) than "
                      f"{'.'.join(map(str, _sys.version_info[:2]))}, {_sys.executable}: configure it with "
                      "-DPython3_EXECUTABLE, or run the interpreter that it is built for")

from . import _alhazen
from ._alhazen import *  # noqa: F401,F403
from ._alhazen import __version__
from . import study
from .progress import ProgressBar
from .rendering import progressive, render

__all__ = sorted([name for name in vars(_alhazen) if not name.startswith("_")]
                 + ["ProgressBar", "progressive", "render", "study", "__version__"])
