"""Values of Python as TOML, in which scenes are described."""

from __future__ import annotations

import json
import math
import os
import sys
from collections.abc import Mapping
from typing import Any

import numpy as np

from ._errors import InputError

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


def read(text: str) -> dict[str, Any]:
    """The tables of a text of TOML; a `ValueError` if it is none."""
    return tomllib.loads(text)


def value(key: str, given: Any) -> str:
    """A value as TOML on one line."""
    if isinstance(given, np.ndarray) or isinstance(given, np.generic):
        given = given.tolist()
    if isinstance(given, bool):
        return "true" if given else "false"
    if isinstance(given, int):
        if not -(2**63) <= given < 2**63:
            raise InputError(f"{key}: {given} has more than 64 bits")
        return str(given)
    if isinstance(given, float):
        if math.isnan(given):
            return "nan"
        if math.isinf(given):
            return "inf" if given > 0 else "-inf"
        return repr(given)
    if isinstance(given, os.PathLike):
        given = os.fspath(given)
    if isinstance(given, str):
        return _string(key, given)
    if isinstance(given, Mapping):
        return "{ " + ", ".join(f"{_string(key, str(k))} = {value(f'{key}.{k}', v)}" for k, v in given.items()) + " }"
    if isinstance(given, (list, tuple)):
        return "[" + ", ".join(value(f"{key}[{i}]", v) for i, v in enumerate(given)) + "]"
    raise InputError(f"{key}: expected a number, a text, a list or a dict, got {type(given).__name__}")


def _string(key: str, text: str) -> str:
    try:
        text.encode("utf-8")
    except UnicodeEncodeError as error:
        raise InputError(f"{key}: {text!r} is no text: {error.reason}") from error
    # JSON escapes what TOML must have escaped, but for the character DEL.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def document(tables: Mapping[str, Any]) -> str:
    """Tables as a document, one key per line."""
    lines = [f"{_string(key, str(key))} = {value(str(key), given)}" for key, given in tables.items()]
    return "\n".join(lines)
