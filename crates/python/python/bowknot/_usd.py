"""USD files that only usd-core reads."""

from __future__ import annotations

import importlib.util
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager

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
    if importlib.util.find_spec("pxr") is None:
        raise InputError(f"{given}: binary USD needs usd-core: pip install usd-core; or usdcat {given} -o text.usda")
    from pxr import Tf

    with tempfile.TemporaryDirectory() as folder:
        text = os.path.join(folder, os.path.splitext(os.path.basename(given))[0] + ".usda")
        try:
            _write_text(given, text)
        except Tf.ErrorException as error:
            raise InputError(f"{given}: usd-core refuses it: {error}") from error
        try:
            yield text
        except InputError as error:
            raise InputError(str(error).replace(text, given)) from None


def _write_text(path: str, text: str) -> None:
    """Writes a stage as one text, with its instances and with skins as points that move."""
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
