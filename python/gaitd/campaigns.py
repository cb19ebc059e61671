"""Campaigns: scenarios with many settings and seeds."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Mapping, Optional, Union

from .errors import ProgramError
from .programs import assignments, gaitctl_json, write_yaml

if TYPE_CHECKING:
    import pandas

__all__ = ["campaign", "results"]


def campaign(
    campaign: Union[str, "os.PathLike[str]", Mapping[str, Any]],
    folder: Union[str, "os.PathLike[str]", None] = None,
    *,
    set: Optional[Mapping[str, Any]] = None,  # as --set of gaitctl
    jobs: Optional[int] = None,
    trust: bool = False,
) -> "pandas.DataFrame":
    """Plays a campaign on all processors and gives a row per run: ``gaitctl campaign``.

    campaign: the path of a file, or a campaign as a dict (docs/campaigns.md), which is written to
    ``<folder>.campaign.yaml``. folder: for results, summary and logs; by default ``<name>-results`` here. Called again
    with the same campaign and folder it goes on where it was, and what is done is not played again. With another
    campaign, a library that was built anew, or another gaitd it needs another folder. set: any keys, for every run, or
    to leave only that value of a key of the campaign. jobs: runs at once. trust: load libraries that the campaign names
    by path.

    The columns are those of ``results.csv``: scenario, seed, settings and draws, success, fell, figures ... Settings
    that are words are plain (``step_plan``), lists and objects their JSON.
    ``frame.attrs["summary"]`` is ``summary.json``: success rates with their intervals, and whether the campaign passed.
    Runs that fail are rows with success 0; nothing is raised. Raises :class:`ProgramError` where gaitctl refuses the
    campaign or the folder, or is interrupted.
    """
    made: Optional[Path] = None
    if isinstance(campaign, Mapping):
        name = str(campaign.get("name", "campaign"))
        target = Path(os.path.abspath(folder if folder is not None else f"{name}-results"))
        if target.name in ("", ".."):
            raise ProgramError(f"{folder}: expected a folder for the results")
        file = target.with_name(target.name + ".campaign.yaml")
        target.parent.mkdir(parents=True, exist_ok=True)
        made = None if file.exists() else file
        write_yaml(file, {"schema": "gaitd.campaign/1", **campaign})
    else:
        file = Path(os.path.abspath(campaign))
        target = Path(os.path.abspath(folder if folder is not None else f"{file.stem}-results"))
    arguments = ["campaign", str(file), "-o", str(target), *assignments(set)]
    if jobs is not None:
        arguments += ["--jobs", str(jobs)]
    if trust:
        arguments.append("--trust")
    try:
        gaitctl_json(arguments)
    except ProgramError:
        if made is not None and not target.exists():  # refused: it has left nothing, and neither do we
            made.unlink()
        raise
    return results(target)


def results(folder: Union[str, "os.PathLike[str]"]) -> "pandas.DataFrame":
    """The results of a campaign that was played, also by gaitctl: as :func:`campaign` gives them."""
    import pandas

    file = Path(folder) / "results.csv"
    # Only what is empty was not measured: "None" and "NA" are words.
    frame = pandas.read_csv(file, float_precision="round_trip", keep_default_na=False, na_values=[""])
    for name, kind in frame.dtypes.items():
        if not pandas.api.types.is_numeric_dtype(kind):
            frame[name] = frame[name].map(_plain_word)
    summary = Path(folder) / "summary.json"
    if summary.exists():
        frame.attrs["summary"] = json.loads(summary.read_text(encoding="utf-8"))
    return frame


def _plain_word(value: Any) -> Any:
    """Settings are JSON in the table: a word that could be something else stands in quotes there."""
    if not isinstance(value, str) or not value.startswith('"'):
        return value
    try:
        return json.loads(value)
    except ValueError:
        return value
