"""A progress bar for terminals and notebooks."""

import html
import sys


class ProgressBar:
    """Shows how far a render is: pass it, or True for a new one, as `progress`.

    In a notebook it is a display that is updated, on a terminal a line that is rewritten, and in a file a line every
    `line_seconds` seconds. It writes to sys.stderr, or to `file`.
    """

    def __init__(self, description="", file=None, width=32, line_seconds=5.0):
        self.description = description
        self.width = width
        self.line_seconds = line_seconds
        self._file = sys.stderr if file is None else file
        self._is_terminal = bool(getattr(self._file, "isatty", lambda: False)())
        self._notebook = None if file is not None else _notebook_display()
        self._handle = None
        self._line = ""
        self._next_line = 0.0
        self._is_closed = False

    def __call__(self, progress):
        """Shows an alhazen.Progress."""
        is_rendering = getattr(progress, "activity", "rendering") == "rendering"
        if not is_rendering and not self._is_terminal and not self._notebook:
            return
        text = self.text(progress)
        if self._notebook:
            self._show_in_notebook(text, progress.fraction)
        elif self._is_terminal:
            padding = " " * max(0, len(self._line) - len(text))
            self._file.write("\r" + text + padding)
            self._file.flush()
            self._line = text
        elif progress.fraction >= 1 or progress.seconds >= self._next_line:
            if text != self._line:
                self._file.write(text + "\n")
                self._file.flush()
            self._line = text
            self._next_line = progress.seconds + self.line_seconds
        if progress.fraction >= 1:
            self.close()

    def close(self):
        """Ends the line on a terminal. The bar does so by itself when the render has ended."""
        if self._is_terminal and self._line and not self._is_closed:
            self._file.write("\n")
            self._file.flush()
        self._is_closed = bool(self._line)

    def __del__(self):
        try:
            self.close()
        except Exception:  # the file may be closed, or the interpreter at its end
            pass

    def text(self, progress):
        """The line that is shown: bar, percent, time so far and time left."""
        activity = getattr(progress, "activity", "rendering")
        if activity != "rendering":
            return (self.description + " " if self.description else "") + f"{activity}, {_clock(progress.seconds)}"
        filled = int(self.width * progress.fraction)
        bar = "#" * filled + "-" * (self.width - filled)
        parts = [f"[{bar}] {100 * progress.fraction:5.1f} %", _clock(progress.seconds)]
        left = _seconds_left(progress)
        if left is not None:
            parts.append(f"{_clock(left)} left")
        if progress.noise > 0:
            parts.append(f"noise {progress.noise:.3g}")
        return (self.description + " " if self.description else "") + ", ".join(parts)

    def _show_in_notebook(self, text, fraction):
        shown = text.replace("[" + text.partition("[")[2].partition("]")[0] + "] ", "")
        data = {"text/plain": text,
                "text/html": f'<progress value="{fraction:.4f}" max="1" style="width: 20em"></progress> '
                             f"<code>{html.escape(shown)}</code>"}
        if self._handle is None:
            self._handle = self._notebook(data, raw=True, display_id=True)
        else:
            self._handle.update(data, raw=True)
        self._line = text


def _seconds_left(progress):
    """By the samples of this run; None before there are any, and at the end."""
    done = progress.samples_done - progress.samples_loaded
    left = progress.samples_total - progress.samples_done
    return progress.seconds * left / done if done > 0 and left > 0 and progress.seconds > 0 else None


def _clock(seconds):
    seconds = int(seconds + 0.5)
    hours, minutes = seconds // 3600, seconds // 60 % 60
    return f"{hours}:{minutes:02d}:{seconds % 60:02d}" if hours else f"{minutes}:{seconds % 60:02d}"


def _notebook_display():
    """IPython's function that displays, if this is a notebook's kernel; it is not imported for that."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    if shell is None or not hasattr(shell, "kernel"):
        return None
    from IPython.display import display
    return display
