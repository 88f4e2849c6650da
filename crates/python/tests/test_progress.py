"""Progress, and runs that replace others."""

import io
import sys
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest
from conftest import grid

import bowknot
from bowknot import InputError
from bowknot._progress import Bar, Follower


def scene(frames=4):
    made = bowknot.Scene.builtin("drape", scale=0.2)
    made.set("simulation.frames", frames)
    return made


def test_a_function_is_told_how_far_a_run_is(tmp_path):
    calls = []
    bowknot.run(scene(), tmp_path / "run", progress=lambda *told: calls.append(told))
    frame, frames, info = calls[-1]
    assert (frame, frames) == (4, 4) and info.step == 4
    made = [call[0] for call in calls]
    assert made == sorted(made)
    before = len(calls)
    bowknot.run(scene(6), tmp_path / "run", resume=True, progress=lambda *told: calls.append(told))
    assert calls[-1][:2] == (6, 6) and len(calls) > before


def test_what_the_function_raises_comes_after_the_run(tmp_path):
    def tell(frame, frames, info):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        bowknot.run(scene(), tmp_path / "run", progress=tell)
    assert bowknot.Run(tmp_path / "run").summary["frames"] == 4
    with pytest.raises(InputError, match="progress: expected"):
        bowknot.run(scene(), tmp_path / "other", progress="yes")


def test_a_follower_reads_whole_lines_only(tmp_path):
    path, calls = tmp_path / "stats.jsonl", []
    follower = Follower(path, 9, lambda *told: calls.append(told))
    follower._look()
    assert calls == []
    path.write_bytes(b"")
    follower._look()
    assert calls == [(0, 9, None)]
    path.write_bytes(b'{"step": 1}\n{"step": 2}\n{"st')
    follower._look()
    assert calls[-1][0] == 2 and calls[-1][2].step == 2
    follower._look()
    assert len(calls) == 2
    path.write_bytes(b'{"step": 1}\n')  # as a resumption does
    follower._look()
    assert calls[-1][0] == 1 and calls[-1][2].step == 1


def test_a_terminal_shows_one_line(monkeypatch, tmp_path):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    shown = Terminal()
    monkeypatch.setattr(sys, "stderr", shown)
    bowknot.run(scene(), tmp_path / "run")
    assert "drape: frame 4 of 4" in shown.getvalue() and shown.getvalue().endswith("\n")
    shown.truncate(0)
    bowknot.run(scene(), tmp_path / "silent", progress=False)
    assert shown.getvalue().strip("\0") == ""
    monkeypatch.setattr(sys, "stderr", None)
    bowknot.run(scene(), tmp_path / "nobody", progress=True)


@pytest.fixture
def notebook(monkeypatch):
    """A notebook that notes what it shows: the content of each display, by time."""
    shown = []

    def display(content, display_id):
        assert display_id is True
        shown.append([content])
        return SimpleNamespace(update=shown[-1].append)

    package, parts = ModuleType("IPython"), ModuleType("IPython.display")
    package.get_ipython = lambda: SimpleNamespace(kernel=object())
    parts.HTML, parts.display = str, display
    monkeypatch.setitem(sys.modules, "IPython", package)
    monkeypatch.setitem(sys.modules, "IPython.display", parts)
    return shown


def test_a_notebook_shows_a_bar(notebook, tmp_path):
    bowknot.run(scene(), tmp_path / "run")
    assert len(notebook) == 1
    assert notebook[0][-1].startswith('<progress value="4" max="4"></progress> drape: frame 4 of 4')
    bowknot.run(scene(), tmp_path / "silent", progress=False)
    assert len(notebook) == 1


def test_a_notebook_shows_pictures_while_they_are_computed(notebook, small):
    try:
        movie = small.play(3, size=(32, 24))
    except bowknot.DeviceError as error:
        pytest.skip(str(error))
    (shown,) = notebook
    assert len(shown) == 5 and len(set(shown)) == 5 and shown[-1] == ""
    for made, content in enumerate(shown[:4]):
        assert "data:image/png;base64," in content and f'value="{made}" max="3"' in content
    assert len(movie) == 4


def test_a_bar_says_how_long_the_rest_takes():
    bar = Bar("what", first=10)
    bar._start -= 30.0
    assert "frame 20 of 40" in bar.text(20, 40) and "1 min 0 s left" in bar.text(20, 40)
    assert 'value="20" max="40"' in bar.html(20, 40)


def test_a_run_is_replaced_only_if_asked_for(tmp_path):
    folder = tmp_path / "run"
    bowknot.run(scene(4), folder)
    (folder / "notes.txt").write_text("mine")
    with pytest.raises(InputError, match="overwrite=True"):
        bowknot.run(scene(2), folder)
    with pytest.raises(InputError, match="only one"):
        bowknot.run(scene(2), folder, overwrite=True, resume=True)
    run = bowknot.run(scene(2), folder, overwrite=True)
    assert len(run.stats) == 2 and len(list((folder / "frames").iterdir())) == 3
    assert (folder / "notes.txt").read_text() == "mine"
    # One that is refused leaves the run that is there.
    crossed = bowknot.Scene()
    vertices, faces = grid(3)
    crossed.add_body(np.concatenate([vertices, vertices]), np.concatenate([faces, faces + 9]), name="twice")
    with pytest.raises(InputError):
        bowknot.run(crossed, folder, overwrite=True)
    assert len(bowknot.Run(folder).stats) == 2 and sorted(path.name for path in folder.iterdir()) == sorted(
        ["backends.json", "checkpoint", "frames", "notes.txt", "scene.toml", "stats.jsonl", "summary.json"]
    )
    assert bowknot.run(scene(3), folder, resume=True).summary["frames"] == 3


def test_what_is_no_run_is_not_replaced(tmp_path):
    (tmp_path / "frames").mkdir()
    (tmp_path / "frames" / "photo.ply").write_text("mine")
    with pytest.raises(InputError, match="already holds a run"):
        bowknot.run(scene(2), tmp_path, overwrite=True)
    assert (tmp_path / "frames" / "photo.ply").read_text() == "mine"


@pytest.mark.skipif(sys.platform == "win32", reason="the test locks as POSIX systems do")
def test_a_run_in_use_is_not_replaced(tmp_path):
    import fcntl

    bowknot.run(scene(2), tmp_path / "run")
    with open(tmp_path / "run" / "checkpoint" / "lock", "r+b") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        with pytest.raises(InputError, match="a run writes to it"):
            bowknot.run(scene(2), tmp_path / "run", overwrite=True)
    assert len(bowknot.Run(tmp_path / "run").stats) == 2
    bowknot.run(scene(1), tmp_path / "run", overwrite=True)


def test_frames_that_are_not_there_are_named(tmp_path):
    run = bowknot.run(scene(2), tmp_path / "run")
    assert len(run.mesh(2).vertices) > 0
    with pytest.raises(InputError, match="frame 3 is not in .*; it holds 0 to 2"):
        run.mesh(3)
    other = scene(2)
    other.set("output.formats", ["npz"])
    with pytest.raises(InputError, match="holds no PLY files; run the scene with"):
        bowknot.run(other, tmp_path / "npz").mesh(0)
