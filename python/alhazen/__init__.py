"""Alhazen, a path tracer: scenes from arrays or files, rendered into NumPy arrays."""

from . import _alhazen
from ._alhazen import *  # noqa: F401,F403
from ._alhazen import __version__
from . import study
from .progress import ProgressBar
from .rendering import progressive, render

__all__ = sorted([name for name in vars(_alhazen) if not name.startswith("_")]
                 + ["ProgressBar", "progressive", "render", "study", "__version__"])
