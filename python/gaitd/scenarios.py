"""Scenarios played and judged."""

from __future__ import annotations

import os
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Union

from .errors import GaitdError
from .log import Log
from .programs import gaitctl_json, assignments, write_yaml
from .verdict import Verdict

__all__ = ["Run", "run"]


@dataclass(frozen=True)
class Run:
    """What came of a scenario.

    ``passed``: nothing went wrong and every expectation holds. ``problems``: what went wrong apart from the
    expectations; ``refusals``: commands that gaitd refused; ``verdict``: None where there was nothing to judge.
    """

    scenario: str
    passed: bool
    verdict: Optional[Verdict]
    problems: List[str]
    refusals: List[str]
    log_file: str
    damaged: bool = False
    _opened: Dict[str, Log] = field(default_factory=dict, repr=False, compare=False)

    @property
    def log(self) -> Log:
        """The log of the run, opened when it is asked for first. Raises :class:`GaitdError` where there is none."""
        if not self.log_file:
            raise GaitdError(f"{self.scenario}: no log: " + "; ".join(self.problems))
        if "log" not in self._opened:
            self._opened["log"] = Log(self.log_file)
        return self._opened["log"]

    @property
    def figures(self) -> Mapping[str, Optional[float]]:
        """Of the verdict. Raises :class:`GaitdError` with the problems where there is none."""
        if self.verdict is None:
            raise GaitdError(f"{self.scenario}: not judged: " + "; ".join(self.problems))
        return self.verdict.figures


def run(
    scenario: Union[str, "os.PathLike[str]", Mapping[str, Any]],
    *,
    set: Optional[Mapping[str, Any]] = None,  # as --set of gaitctl
    log: Union[str, "os.PathLike[str]", None] = None,
    robot: Optional[str] = None,
    trust: bool = False,
) -> Run:
    """Plays a scenario on a private gaitd in lockstep, as fast as the machine can, and judges it: ``gaitctl run``.

    scenario: a name (``"flat-0.35"``), the path of a file, or a scenario as a dict (docs/scenarios.md). set: any keys
    of the configuration or the scenario, ``{"seed": 2, "gait.swing_height": 0.12}``. log: a file or a folder for the
    log; by default a new file in ``~/.local/state/gaitd/logs``. robot: in place of that of the scenario. trust: load
    libraries that the scenario names by path; those in ``set`` are loaded anyway.

    A run that fails its expectations is a :class:`Run` that did not pass; nothing is raised. Raises
    :class:`ProgramError` where gaitctl cannot be run or is interrupted.
    """
    arguments = assignments(set)
    if log is not None:
        arguments += ["--log", os.path.abspath(log) + ("/" if str(log).endswith("/") else "")]
    if robot is not None:
        arguments += ["--robot", robot]
    if trust:
        arguments.append("--trust")
    if not isinstance(scenario, Mapping):
        return _result(gaitctl_json(["run", os.fspath(scenario), *arguments]))
    with tempfile.TemporaryDirectory(prefix="gaitd-") as folder:
        file = Path(folder) / f"{_file_name(scenario)}.yaml"
        write_yaml(file, {"schema": "gaitd.scenario/1", **scenario})
        return _result(gaitctl_json(["run", str(file), *arguments]))


def _file_name(document: Mapping[str, Any]) -> str:
    name = str(document.get("name", ""))
    return name if name and "/" not in name and not name.startswith(".") else "scenario"


def _result(json: Mapping[str, Any]) -> Run:
    report = json["scenarios"][0]
    verdict = None if report["verdict"] is None else Verdict.of(report["verdict"])
    return Run(
        report["scenario"],
        report["pass"],
        verdict,
        list(report["problems"]),
        list(report["refusals"]),
        report["log"],
        report["damaged"],
    )
