"""What a run was judged to be."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Dict, List, Mapping, Optional

__all__ = ["Expectation", "Verdict"]


@dataclass(frozen=True)
class Expectation:
    """One expectation of a scenario. ``value`` is what was measured (None: it could not be), ``figure`` and ``bound``
    are for people."""

    name: str
    passed: bool
    value: Optional[float]
    figure: str
    bound: str
    note: str = ""


@dataclass(frozen=True)
class Verdict:
    """Expectations and figures of a run, as ``gaitctl run`` tells them.

    ``figures`` are by name, None where the log does not show them; ``units`` of those that have one.
    """

    passed: bool
    expectations: List[Expectation]
    figures: Dict[str, Optional[float]]
    units: Dict[str, str] = field(repr=False)

    @classmethod
    def of(cls, json: Mapping[str, Any]) -> "Verdict":
        """From the JSON of gaitctl."""
        expectations = [
            Expectation(one["name"], one["pass"], one["value"], one["figure"], one["bound"], one.get("note", ""))
            for one in json["expectations"]
        ]
        return cls(json["pass"], expectations, dict(json["figures"]), dict(json["units"]))

    def failed(self) -> List[Expectation]:
        """Those that do not hold."""
        return [one for one in self.expectations if not one.passed]
