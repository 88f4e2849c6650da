"""Moving pictures; they need a graphics driver, which the variable BOWKNOT_NEED_DRIVER demands."""

import os
import struct
import zlib

import numpy as np
import pytest
from conftest import grid

import bowknot
from bowknot import DeviceError, InputError
from bowknot._png import animated_png, png


def chunks(content):
    assert content[:8] == b"\x89PNG\r\n\x1a\n"
    found, at = [], 8
    while at < len(content):
        (length,) = struct.unpack(">I", content[at : at + 4])
        kind, data = content[at + 4 : at + 8], content[at + 8 : at + 8 + length]
        assert struct.unpack(">I", content[at + 8 + length : at + 12 + length])[0] == zlib.crc32(kind + data)
        found.append((kind, data))
        at += 12 + length
    return found


def pixels_of(data, height, width):
    rows = np.frombuffer(zlib.decompress(data), np.uint8).reshape(height, 1 + 3 * width)
    assert (rows[:, 0] == 0).all()
    return rows[:, 1:].reshape(height, width, 3)


def test_files_hold_the_pixels():
    frames = [np.random.default_rng(seed).integers(0, 256, (5, 7, 3), np.uint8) for seed in range(3)]
    still = dict(chunks(png(frames[0])))
    assert (pixels_of(still[b"IDAT"], 5, 7) == frames[0]).all()
    found = chunks(animated_png(frames, 0.04))
    kinds = [kind for kind, _ in found]
    assert kinds == [b"IHDR", b"acTL", b"fcTL", b"IDAT", b"fcTL", b"fdAT", b"fcTL", b"fdAT", b"IEND"]
    assert struct.unpack(">II", found[1][1]) == (3, 0)
    numbers = [struct.unpack(">I", data[:4])[0] for kind, data in found if kind in (b"fcTL", b"fdAT")]
    assert numbers == list(range(5))
    assert struct.unpack(">HH", found[2][1][20:24]) == (40, 1000)
    for index, frame in zip((3, 5, 7), frames, strict=True):
        data = found[index][1] if index == 3 else found[index][1][4:]
        assert (pixels_of(data, 5, 7) == frame).all()


@pytest.fixture
def driver():
    try:
        bowknot.render(*grid(2), size=(16, 16), quality="fast")
    except DeviceError as error:
        if os.environ.get("BOWKNOT_NEED_DRIVER"):
            raise
        pytest.skip(str(error))


def test_a_simulation_plays(small, driver, tmp_path, capsys):
    told = []
    movie = small.play(5, every=2, speed=0.5, size=(64, 48), progress=lambda *call: told.append(call[:2]))
    assert small.frame == 5 and told == [(made, 5) for made in range(6)]
    # The states before, after 2, 4 and 5 time steps.
    dt = small.scene.dt
    assert len(movie) == 4 and np.allclose(movie.times, [0.0, 2 * dt, 4 * dt, 5 * dt])
    assert movie.frames[0].shape == (48, 64, 3) and (movie.frames[0] != movie.frames[-1]).any()
    assert movie.seconds_per_frame == 4 * dt
    shown = small.render(size=(64, 48), quality="fast")
    assert np.abs(movie.frames[-1].astype(int) - shown).max() <= 2
    page = movie._repr_html_()
    assert page.count("<script>") == 1 and 'max="3" value="3"' in page
    movie.save(tmp_path / "movie.png")
    assert [kind for kind, _ in chunks((tmp_path / "movie.png").read_bytes())].count(b"fcTL") == 4
    again = small.play(1, size=(64, 48), progress=True)
    assert [info.step for info in movie.infos] == [1, 2, 3, 4, 5]
    assert len(again) == 2 and "play: frame 6 of 6" in capsys.readouterr().err


def test_what_cannot_be_played_is_refused(small):
    for options in ({"frames": -1}, {"every": 0}, {"speed": 0.0}, {"speed": np.inf}, {"progress": 3}):
        with pytest.raises(InputError):
            small.play(**options)
    assert small.frame == 0
