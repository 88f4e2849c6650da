"""Calls into the native part: warnings of the library go to the logger ``bowknot``, and its messages name what
Python has."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import TypeVar

from . import _native
from ._errors import BowknotError

logger = logging.getLogger("bowknot")

#: What messages name for users of Rust and of the command, and what it is called here.
_NAMES = (
    ("`ResolveInput::prescribed`", "`fixed`"),
    ("`Resolver::detect_intersections`", "`bowknot.check`"),
    ("the command `bowknot repair`", "`bowknot.repair`"),
    ("`bowknot info` lists them", "its report counts them"),
    (
        "resume it, choose another folder, or remove it",
        "continue it with `resume=True`, replace it with `overwrite=True`, or choose another folder",
    ),
)

#: Files that the library reads in the place of others, and those, which messages name.
_FILES: dict[str, str] = {}

_T = TypeVar("_T")


def call(function: Callable[..., _T], *arguments: object) -> _T:
    """Calls a native function and logs what the library warned of meanwhile."""
    try:
        return function(*arguments)
    except BowknotError as error:
        error.args = tuple(_translated(part) if isinstance(part, str) else part for part in error.args)
        raise
    finally:
        for level, text in _native.take():
            logger.log(level, "%s", _translated(text))


def read_instead(file: str, named: str | None) -> None:
    """Says that the library reads a file in the place of another one, or does so no more."""
    if named is None:
        _FILES.pop(file, None)
    else:
        _FILES[file] = named


def _translated(text: str) -> str:
    for there, here in (*_FILES.items(), *_NAMES):
        text = text.replace(there, here)
    return text
