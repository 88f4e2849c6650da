"""USD files that only usd-core reads."""

from __future__ import annotations

import hashlib
import importlib.util
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ._call import read_instead
from ._errors import InputError

#: How a binary layer begins.
_CRATE = b"PXR-USDC"


@contextmanager
def as_text(path: str | os.PathLike[str]) -> Iterator[str]:
    """The path of a file that the library reads: of a binary stage or an archive, a text of it for the time being,
    with what it refers to; of all else itself.

    Raises
    ------
    InputError
        usd-core is not installed, or refuses the file.
    """
    given = os.fspath(path)
    if not needs_usd(given):
        yield given
        return
    with tempfile.TemporaryDirectory() as folder:
        text = os.path.join(folder, Path(given).stem + ".usda")
        _write_text(given, text)
        read_instead(text, given)
        try:
            yield text
        finally:
            read_instead(text, None)


def kept_text(path: str | os.PathLike[str]) -> str:
    """The same for a file that is read later, by a scene that may be saved: the text is kept in the user's cache
    folder, named by its content.

    Raises
    ------
    InputError
        usd-core is not installed, or refuses the file; a cache folder that cannot be written.
    """
    given = os.path.abspath(path)
    home = os.environ.get("LOCALAPPDATA" if os.name == "nt" else "XDG_CACHE_HOME") or Path.home() / ".cache"
    cache = Path(home) / "bowknot"
    try:
        cache.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=cache) as folder:
            new = Path(folder) / "new.usda"
            _write_text(given, str(new))
            digest = hashlib.sha256(new.read_bytes()).hexdigest()[:16]
            kept = cache / f"{Path(given).stem}-{digest}.usda"
            os.replace(new, kept)
    except OSError as error:
        raise InputError(f"{given}: its text cannot be kept in {cache}: {error}") from error
    read_instead(str(kept), given)
    return str(kept)


def _write_text(given: str, text: str) -> None:
    """Writes a stage as one text, with its instances and with skins as points that move."""
    if importlib.util.find_spec("pxr") is None:
        raise InputError(f"{given}: binary USD needs usd-core: pip install usd-core; or usdcat {given} -o text.usda")
    from pxr import Tf

    try:
        _flatten(given, text)
    except Tf.ErrorException as error:
        raise InputError(f"{given}: usd-core refuses it: {error}") from error


def _flatten(path: str, text: str) -> None:
    from pxr import Gf, Usd, UsdSkel

    stage = Usd.Stage.Open(path)
    stage.SetEditTarget(stage.GetSessionLayer())
    while instances := [prim for prim in stage.Traverse() if prim.IsInstance()]:
        for prim in instances:
            prim.SetInstanceable(False)
    flat = Usd.Stage.Open(stage.Flatten())
    start, end = flat.GetStartTimeCode(), flat.GetEndTimeCode()
    for prim in flat.Traverse():
        if prim.IsA(UsdSkel.Root):
            UsdSkel.BakeSkinning(UsdSkel.Root(prim), Gf.Interval(start, end))
    flat.Export(text)


def needs_usd(given: str | os.PathLike[str]) -> bool:
    """Whether usd-core must read a file: a binary layer or an archive."""
    path = os.fspath(given)
    ending = os.path.splitext(path)[1].lower()
    if ending in (".usdc", ".usdz"):
        return True
    if ending != ".usd":
        return False
    try:
        with open(path, "rb") as file:
            return file.read(len(_CRATE)) == _CRATE
    except OSError:
        # The library says what is wrong.
        return False
