"""Progress of what takes long: a line of a terminal, or a bar in a notebook."""

from __future__ import annotations

import html
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ._errors import InputError
from ._info import StepInfo

#: What a caller may give: ``callback(frame, frames, info)``; ``info`` is None before the first time step.
Callback = Callable[[int, int, "StepInfo | None"], Any]

#: How often the file of statistics is looked at [s].
_POLL = 0.1
#: Least time between two updates of what is shown [s].
_REFRESH = 0.2


def in_notebook() -> bool:
    """Whether a kernel of Jupyter runs this program."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return getattr(shell, "kernel", None) is not None


class Display:
    """A place in the output of a notebook's cell whose content changes."""

    def __init__(self) -> None:
        self._handle: Any = None

    def show(self, content: str) -> None:
        """Shows HTML in place of what was shown."""
        from IPython.display import HTML, display

        if self._handle is None:
            self._handle = display(HTML(content), display_id=True)
        else:
            self._handle.update(HTML(content))


class Bar:
    """Shows how many time steps are made, and about how long the others take.

    Parameters
    ----------
    what : str
        What goes on.
    first : int, optional
        The frame at which it begins. Default: the first that is shown.
    """

    def __init__(self, what: str, first: int | None = None) -> None:
        self._what = what
        self._start = time.monotonic()
        self._first = first
        self._shown = float("-inf")
        self._display = Display() if in_notebook() else None

    def __call__(self, frame: int, frames: int, info: StepInfo | None = None) -> None:
        """Shows that so many of the frames are made; not more often than one can see."""
        if self._first is None:
            self._first = frame
        now = time.monotonic()
        if now - self._shown < _REFRESH and frame < frames:
            return
        self._shown = now
        text = self.text(frame, frames)
        if self._display is not None:
            self._display.show(self.html(frame, frames))
        else:
            # Over the line before, which may be longer.
            _write(f"\r{self._what}: {text}".ljust(79))

    def text(self, frame: int, frames: int) -> str:
        """Frames, time so far, and the time that the rest takes if it is like what was."""
        seconds = time.monotonic() - self._start
        text = f"frame {frame} of {frames}, {_duration(seconds)}"
        made = frame - (self._first or 0)
        if 0 < made and frame < frames:
            text += f", {_duration(seconds / made * (frames - frame))} left"
        return text

    def html(self, frame: int, frames: int) -> str:
        """The same as a bar."""
        text = html.escape(f"{self._what}: {self.text(frame, frames)}")
        return f'<progress value="{frame}" max="{max(frames, 1)}"></progress> {text}'

    def end(self) -> None:
        """Leaves the line of a terminal."""
        if self._display is None and self._first is not None:
            _write("\n")


def callback_of(progress: bool | Callback | None, what: str) -> Callback | None:
    """What is called for progress: a bar where someone sees it by default, always for True, never for False."""
    if callable(progress):
        return progress
    if progress not in (None, True, False):
        raise InputError(f"progress: expected True, False or a function, got {type(progress).__name__}")
    seen = in_notebook() or (sys.stderr is not None and sys.stderr.isatty())
    return Bar(what) if progress or (progress is None and seen) else None


class Follower:
    """Follows the statistics of a run while it goes on, on a thread of its own.

    Parameters
    ----------
    path : path
        The file ``stats.jsonl``, which the run appends to.
    frames : int
        Time steps of the run, those before a resumption included.
    callback
        What is called, on that thread.
    """

    def __init__(self, path: Path, frames: int, callback: Callback) -> None:
        self._path, self._frames, self._callback = path, frames, callback
        #: Time steps of the file so far, how much of it was read, and its last line.
        self._made, self._read, self._last = -1, 0, b""
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._follow, name="bowknot progress", daemon=True)
        #: What the callback raised, which ends the calls.
        self.error: BaseException | None = None

    def __enter__(self) -> Follower:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._thread.join()
        if isinstance(self._callback, Bar):
            self._callback.end()

    def _follow(self) -> None:
        try:
            going = True
            while going:
                # The last look comes after the run has ended.
                going = not self._ended.wait(_POLL)
                self._look()
        except BaseException as error:
            self.error = error

    def _look(self) -> None:
        try:
            with open(self._path, "rb") as file:
                # A resumption drops the lines after its checkpoint.
                if file.seek(0, 2) < self._read:
                    self._made, self._read, self._last = -1, 0, b""
                file.seek(self._read)
                content = file.read()
        except FileNotFoundError:
            return
        whole = content[: content.rfind(b"\n") + 1]
        if whole or self._made < 0:
            lines = whole.splitlines()
            self._made = max(self._made, 0) + len(lines)
            self._read += len(whole)
            self._last = lines[-1] if lines else self._last
            info = StepInfo(self._last.decode("utf-8")) if self._last else None
            self._callback(self._made, self._frames, info)


def _write(text: str) -> None:
    # Programs without a console have no standard error.
    if sys.stderr is not None:
        sys.stderr.write(text)
        sys.stderr.flush()


def _duration(seconds: float) -> str:
    if seconds < 60:
        return f"{seconds:.1f} s"
    minutes, seconds = divmod(round(seconds), 60)
    return f"{minutes} min {seconds} s"
