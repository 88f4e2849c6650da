"""Studies: what is varied, and how the runs are made."""

from __future__ import annotations

import dataclasses
import difflib
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .._errors import InputError
from .._meshes import is_path
from .._scene import Scene
from .._toml import read as parsed
from ._design import Range, cases

#: Endings of tables.
TABLES = (".parquet", ".csv", ".jsonl")


@dataclass
class Study:
    """A study. Its fields are the keys of a study file."""

    #: Name of a built-in scene, path of a scene file, a table with a whole scene, or a `Scene`.
    scene: Any = None
    #: Resolution of a built-in scene.
    scale: float = 1.0
    #: Keys of the scene that all runs have set.
    set: dict[str, Any] = field(default_factory=dict)
    #: The values of each key; all combinations are run.
    grid: dict[str, list[Any]] = field(default_factory=dict)
    #: Keys and values, run by run.
    case: list[dict[str, Any]] = field(default_factory=list)
    #: Latin hypercube: `samples`, `seed`, and `keys` with a range each.
    latin: dict[str, Any] = field(default_factory=dict)
    #: Folder, or a URL of fsspec.
    out: str = ""
    #: Name of the table in `out`; its ending decides the format.
    table: str = "table.parquet"
    #: Whether every accepted state and path is judged.
    check: bool = False
    #: Patterns of the files of a run that are kept, besides its scene and its summary.
    keep: list[str] = field(default_factory=lambda: ["*"])
    #: Threads, and cores, of each run.
    threads: int = 1
    #: How often a run whose worker is lost is tried again.
    retries: int = 2
    #: Longest wall time of a run [s].
    time_limit: float | None = None
    #: What paths are relative to.
    folder: Path = Path()

    def cases(self) -> Iterable[dict[str, Any]]:
        """The keys and values of each run, in order."""
        ranges = {key: Range(**given) for key, given in self.latin.get("keys", {}).items()}
        return cases(self.grid, self.case, ranges, self.latin.get("samples", 0), self.latin.get("seed", 0))


def read(study: Mapping[str, Any] | str | os.PathLike[str], out: str | os.PathLike[str] | None) -> Study:
    """A study from a file or from a dict of the same content.

    Raises
    ------
    InputError
        A missing file, text that is not TOML, unknown keys, wrong types, ranges without numbers; every problem with
        its key.
    """
    if isinstance(study, Mapping):
        where, folder, given = "study", Path(), dict(study)
    else:
        if not is_path(study):
            raise InputError(f"study: expected a path or a dict, got {type(study).__name__}")
        where, folder = os.fspath(study), Path(study).parent
        try:
            given = parsed(Path(study).read_text(encoding="utf-8"))
        except OSError as error:
            raise InputError(f"{where}: cannot be read: {error.strerror}") from error
        except ValueError as error:
            raise InputError(f"{where}: not TOML: {error}") from error
    problems: list[str] = []
    known = [entry.name for entry in dataclasses.fields(Study) if entry.name != "folder"]
    _known(given, known, "", problems)
    for key, check in _CHECKS.items():
        if key in given:
            problem = check(given[key])
            if problem:
                problems.append(f"{key}: {problem}")
    if not problems:
        given["set"] = flat(given.get("set", {}))
        given["grid"] = flat(given.get("grid", {}))
        given["case"] = [flat(entry) for entry in given.get("case", [])]
        if "latin" in given:
            given["latin"] = {**given["latin"], "keys": _ranges(given["latin"].get("keys", {}))}
        _combined(given, problems)
    if problems:
        raise InputError("\n".join(f"{where}: {problem}" for problem in problems))
    default = Path("out") / ("sweep" if isinstance(study, Mapping) else Path(where).stem)
    given["out"] = os.fspath(out if out is not None else given.get("out", default))
    if "://" not in given["out"]:
        given["out"] = os.path.abspath(given["out"])
    return Study(**given, folder=folder)


def flat(table: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """A table of keys with dots. Keys that are written without quotes make tables in TOML; one with dots within
    quotes has whatever stands behind it for its value."""
    found: dict[str, Any] = {}
    for key, value in table.items():
        if isinstance(value, Mapping) and "." not in key:
            found.update(flat(value, f"{prefix}{key}."))
        else:
            found[prefix + key] = value
    return found


def _ranges(table: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """As `flat`, but a range is a value."""
    found: dict[str, Any] = {}
    for key, value in table.items():
        if isinstance(value, Mapping) and not ({"low", "high"} & value.keys()) and value:
            found.update(_ranges(value, f"{prefix}{key}."))
        else:
            found[prefix + key] = value
    return found


def _known(given: Mapping[str, Any], known: list[str], prefix: str, problems: list[str]) -> None:
    for key in given:
        if key not in known:
            nearest = difflib.get_close_matches(str(key), known, 1, 0.5)
            hint = f"did you mean {prefix}{nearest[0]}?" if nearest else f"known here: {', '.join(known)}"
            problems.append(f"{prefix}{key}: unknown key; {hint}")


def _combined(given: dict[str, Any], problems: list[str]) -> None:
    """Checks what is varied."""
    for key, values in given["grid"].items():
        if not isinstance(values, (list, tuple)) or not values:
            problems.append(f"grid.{key}: expected a list of values")
    latin = given.get("latin", {})
    _known(latin, ["samples", "seed", "keys"], "latin.", problems)
    for key, least in (("samples", 1), ("seed", 0)):
        value = latin.get(key, least)
        if not _is_int(value) or value < least:
            problems.append(f"latin.{key}: {value!r} must be a whole number from {least} up")
    if latin and not (latin.get("keys") and "samples" in latin):
        problems.append("latin: needs samples and keys, each key with low and high")
    for key, value in latin.get("keys", {}).items():
        problem = Range.problem(value)
        if problem:
            problems.append(f"latin.keys.{key}: {problem}")
    listed = {key for entry in given["case"] for key in entry}
    varied = [*given["grid"], *listed, *latin.get("keys", {})]
    for key in sorted({key for key in varied if varied.count(key) > 1}):
        problems.append(f"{key}: it is varied in two ways; leave it in one of grid, case and latin")
    if "scene" not in given and not ("scene" in given["grid"] or "scene" in listed):
        problems.append("scene: missing; give a built-in scene, the path of a scene file or a table")


def _is_int(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _whole(least: int, most: int) -> Any:
    return lambda v: None if _is_int(v) and least <= v <= most else f"{v!r} must be a whole number, {least} to {most}"


def _kind(kind: Any, words: str) -> Any:
    return lambda v: None if isinstance(v, kind) else f"expected {words}, got {type(v).__name__}"


def _positive(value: Any) -> str | None:
    fits = isinstance(value, (int, float)) and not isinstance(value, bool) and value > 0
    return None if fits else f"{value!r} must be a number above 0"


def _table(value: Any) -> str | None:
    fits = isinstance(value, str) and value.endswith(TABLES) and Path(value).name == value
    return None if fits else f"{value!r} must be a name that ends in one of {', '.join(TABLES)}"


def _entries(kind: Any, words: str) -> Any:
    def problem(value: Any) -> str | None:
        fits = isinstance(value, (list, tuple)) and all(isinstance(entry, kind) for entry in value)
        return None if fits else f"expected a list of {words}"

    return problem


#: What is wrong with the value of a key, if anything.
_CHECKS: dict[str, Any] = {
    "scene": _kind((str, os.PathLike, Mapping, Scene), "a name, a path or a table"),
    "scale": _positive,
    "set": _kind(Mapping, "a table"),
    "grid": _kind(Mapping, "a table"),
    "case": _entries(Mapping, "tables"),
    "latin": _kind(Mapping, "a table"),
    "out": _kind((str, os.PathLike), "a path"),
    "table": _table,
    "check": _kind(bool, "true or false"),
    "keep": _entries(str, "patterns"),
    "threads": _whole(1, 1024),
    "retries": _whole(0, 1000),
    "time_limit": _positive,
}
