"""Calls into the native part: warnings of the library go to the logger ``bowknot``."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import TypeVar

from . import _native

logger = logging.getLogger("bowknot")

_T = TypeVar("_T")


def call(function: Callable[..., _T], *arguments: object) -> _T:
    """Calls a native function and logs what the library warned of meanwhile."""
    try:
        return function(*arguments)
    finally:
        for level, text in _native.take():
            logger.log(level, "%s", text)
