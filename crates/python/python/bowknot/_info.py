"""What a call did, by name."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any


class Info(Mapping[str, Any]):
    """What a call did and how it ended.

    Each number is an attribute and an entry: ``info.converged`` is ``info["converged"]``. It is read when it is
    first asked for. ``dict(info)`` has them all, with the names and units of the documented statistics.
    """

    __slots__ = ("_entries", "_text")

    def __init__(self, text: str) -> None:
        self._text = text
        self._entries: dict[str, Any] | None = None

    def _all(self) -> dict[str, Any]:
        if self._entries is None:
            self._entries = json.loads(self._text)
        return self._entries

    def __getitem__(self, name: str) -> Any:
        return self._all()[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._all())

    def __len__(self) -> int:
        return len(self._all())

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        if name in self._all():
            return self._all()[name]
        raise AttributeError(f"{type(self).__name__} has no {name!r}; it has {', '.join(self._all())}")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._all()]

    def __repr__(self) -> str:
        shown = ", ".join(f"{k}={v!r}" for k, v in self._all().items() if isinstance(v, (bool, int, float)))
        return f"{type(self).__name__}({shown})"

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._text,)


class StepInfo(Info):
    """What a time step did, as a line of ``stats.jsonl``: ``solved``, ``two_way_steps``, ``min_gap_m``,
    ``max_stretch``, ``residual_m``, ``energy``, ``seconds`` and others."""

    __slots__ = ()
