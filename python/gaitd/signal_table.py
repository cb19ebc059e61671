"""The signals of a log: names, kinds, units, and how their values become numpy arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, Iterable, List, Mapping, Tuple

import numpy as np

from . import _native
from .arrays import Array, Floats
from .errors import MissingSignal

__all__ = ["Signal"]

_NO_INTEGER = np.iinfo(np.int64).min


@dataclass(frozen=True)
class Signal:
    """One signal of a log.

    ``kind`` is ``real`` (float64 in arrays), ``integer`` (int64; -2**63 where the log has no number), ``boolean``
    (bool) or ``enumeration`` (int8: the index of the word in ``words``, -1 where there was none). ``unit`` is SI or
    empty.
    """

    name: str
    kind: str
    unit: str
    words: Tuple[str, ...] = ()

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the values in arrays."""
        return np.dtype({"real": "f8", "integer": "i8", "boolean": "?", "enumeration": "i1"}[self.kind])

    def convert(self, values: Floats) -> Array:
        """Doubles as the reader gives them (NaN: no value) in this signal's type."""
        if self.kind == "real":
            return values
        missing = np.isnan(values)
        if self.kind == "boolean":
            return values > 0.0
        filler = _NO_INTEGER if self.kind == "integer" else -1
        result = np.where(missing, 0.0, values).astype(self.dtype)
        result[missing] = filler
        return result


def signal_table(rows: Iterable[Tuple[str, str, str, List[str]]]) -> Dict[str, Signal]:
    """By name, in the order of the log."""
    return {name: Signal(name, kind, unit, tuple(words)) for name, kind, unit, words in rows}


def choose(signals: Mapping[str, Signal], patterns: Iterable[str]) -> List[str]:
    """Names that the patterns match, pattern by pattern, each once. ``*`` matches slashes too."""
    chosen: Dict[str, None] = {}
    for pattern in patterns:
        if pattern in signals:
            chosen[pattern] = None
            continue
        found = [name for name in signals if _native.glob_match(pattern, name)]
        if not found:
            raise missing(pattern, list(signals))
        chosen.update(dict.fromkeys(found))
    return list(chosen)


def missing(name: str, known: List[str], what: str = "signal") -> MissingSignal:
    """The error for a name that is not there, with the nearest one that is."""
    return MissingSignal(f"no {what} '{name}'; {_native.suggestion(name, known)}")
