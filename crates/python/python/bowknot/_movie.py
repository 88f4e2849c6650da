"""Moving pictures of simulations, shown while they are computed."""

from __future__ import annotations

import base64
import html
import json
import os
import uuid
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._errors import InputError
from ._info import StepInfo
from ._png import animated_png, png
from ._progress import Bar, Callback, Display, callback_of, in_notebook

#: Colors of frames are multiples of this, which makes their files smaller.
_COLOR_STEP = 4

#: Plays the frames of a page: a button, a slider, and the number of the frame.
_SCRIPT = """
const root = document.getElementById(ID), image = root.querySelector("img");
const button = root.querySelector("button"), slider = root.querySelector("input");
const label = root.querySelector("output");
let timer = null;
const show = () => {
  image.src = "data:image/png;base64," + frames[slider.value];
  label.textContent = labels[slider.value];
};
const stop = () => { clearInterval(timer); timer = null; button.textContent = "play"; };
const next = () => {
  if (!document.contains(root)) { stop(); return; }
  slider.value = (Number(slider.value) + 1) % frames.length;
  show();
};
button.onclick = () => {
  if (timer === null) { timer = setInterval(next, INTERVAL); button.textContent = "pause"; } else { stop(); }
};
slider.oninput = () => { stop(); show(); };
"""


class Movie:
    """Pictures of a simulation over time. As the last line of a notebook's cell it plays; without scripts, as in an
    exported page, its last frame is shown.

    Attributes
    ----------
    frames : list of ndarray of uint8, shape (height, width, 3)
        The pictures.
    times : list of float
        Their times in the simulation [s].
    seconds_per_frame : float
        How long each is shown [s].
    infos : list of StepInfo
        What the time steps did, one for each.
    """

    def __init__(
        self,
        frames: list[NDArray[np.uint8]],
        times: list[float],
        seconds_per_frame: float,
        infos: list[StepInfo] | None = None,
    ) -> None:
        self.frames, self.times, self.seconds_per_frame = frames, times, seconds_per_frame
        self.infos: list[StepInfo] = [] if infos is None else infos

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes it as an animated PNG, which browsers play."""
        Path(path).write_bytes(animated_png(self.frames, self.seconds_per_frame))

    def __len__(self) -> int:
        return len(self.frames)

    def __repr__(self) -> str:
        return f"Movie({len(self.frames)} frames from {self.times[0]:g} to {self.times[-1]:g} s)"

    def _repr_html_(self) -> str:
        name = json.dumps(f"bowknot-{uuid.uuid4().hex[:12]}")
        pictures = [_base64(frame) for frame in self.frames]
        labels = [f"{time:.2f} s" for time in self.times]
        last = len(pictures) - 1
        script = _SCRIPT.replace("ID", name, 1).replace("INTERVAL", str(round(1000 * self.seconds_per_frame)))
        return (
            f'<div id={name}><img src="data:image/png;base64,{pictures[-1]}"/><br/>'
            f'<button>play</button> <input type="range" min="0" max="{last}" value="{last}"/> '
            f"<output>{html.escape(labels[-1])}</output></div>"
            f"<script>(() => {{ const frames = {json.dumps(pictures)}, labels = {json.dumps(labels)};"
            f"{script} }})();</script>"
        )


def play(
    simulator: Any,
    frames: int | None = None,
    *,
    every: int = 1,
    speed: float = 1.0,
    progress: bool | Callback | None = None,
    size: tuple[int, int] = (480, 360),
    quality: str = "fast",
    **options: Any,
) -> Movie:
    """Makes time steps and pictures of them; see `Simulator.play`."""
    count = max(simulator.scene.frames - simulator.frame, 0) if frames is None else int(frames)
    every = int(every)
    if count < 0 or every < 1:
        raise InputError(f"frames {count}, every {every}: expected at least 0 and 1")
    if not 0.0 < float(speed) < float("inf"):
        raise InputError(f"speed {speed}: it must be a number above 0")
    first, dt = simulator.frame, simulator.scene.dt
    tell = callback_of(progress, "play")
    # Where a bar would be shown in a notebook, pictures are shown above it.
    bar = Bar("play", first)
    display = Display() if isinstance(tell, Bar) and in_notebook() else None
    pictures: list[NDArray[np.uint8]] = []
    times: list[float] = []
    infos: list[StepInfo] = []

    def look(made: int) -> None:
        if made % every == 0 or made == count:
            pixels = simulator.render(size=size, quality=quality, **options)
            pictures.append(pixels // _COLOR_STEP * _COLOR_STEP + _COLOR_STEP // 2)
            times.append(simulator.time)

    def show(made: int, info: Any) -> None:
        if display is not None:
            picture = _base64(pictures[-1])
            progress_bar = bar.html(first + made, first + count)
            display.show(f'<img src="data:image/png;base64,{picture}"/><br/>{progress_bar}')
        elif tell is not None:
            tell(first + made, first + count, info)

    look(0)
    show(0, None)
    try:
        for made in range(1, count + 1):
            infos.append(simulator.step())
            look(made)
            show(made, infos[-1])
    finally:
        if display is not None:
            # The picture is that of the movie, which is shown if it is the last line of a cell.
            display.show("")
        elif isinstance(tell, Bar):
            tell.end()
    return Movie(pictures, times, every * dt / float(speed), infos)


def _base64(pixels: NDArray[np.uint8]) -> str:
    return base64.b64encode(png(pixels)).decode("ascii")
