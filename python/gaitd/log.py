"""Logs as numpy arrays and pandas frames."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _native
from .arrays import Array, Floats
from .errors import DamagedLog, LogError
from .model import Model, placed
from .signal_table import Signal, choose, missing, signal_table
from .verdict import Verdict

if TYPE_CHECKING:
    import pandas

__all__ = ["Event", "Log"]

_POSE = ("x", "y", "z", "roll", "pitch", "yaw")
_ROWS_AT_ONCE = 1 << 16


@dataclass(frozen=True)
class Event:
    """Something that happened: a command, a state, a fault, a push ... (docs/log-format.md).

    ``time`` in s of the tick clock; ``text`` is what the event says, as a dict, or a text that is no JSON.
    """

    tick: int
    time: float
    kind: str
    text: Any


class Log(Mapping[str, Array]):
    """A log of gaitd, read by signal.

    >>> log = gaitd.Log("walk.mcap")
    >>> log["icp/x"]                 # float64 of shape (ticks,), m, world frame
    >>> log.frame(["com/*", "gait/phase"])

    The first time a log is opened all of it is read, its checksums are checked, and its columns are kept in a file
    beside it (``walk.mcap.columns``), or in ``~/.cache/gaitd/columns`` where its folder cannot be written to. From
    then on opening takes milliseconds, and only the signals that are asked for are read. The file may be deleted at
    any time; a log that has changed since is read again.

    path: the log. damaged: ``"refuse"`` raises :class:`DamagedLog` for a log that lacks something, ``"read"`` reads
    what is left; ``damage`` says what is missing. keep: False keeps the columns only as long as this object.

    Raises :class:`LogError`, with the words of the reader, for what is no log. Safe to use from several threads.
    """

    def __init__(self, path: Union[str, "os.PathLike[str]"], *, damaged: str = "refuse", keep: bool = True):
        if damaged not in ("refuse", "read"):
            raise ValueError(f"damaged={damaged!r}: expected 'refuse' or 'read'")
        self._path = os.fspath(path)
        try:
            self._native = _native.Log(self._path, keep)
        except RuntimeError as error:
            raise LogError(str(error)) from None
        self._info: Dict[str, Any] = json.loads(self._native.info)
        if self.damage and damaged == "refuse":
            raise DamagedLog(self._path, self.damage)
        self._signals = signal_table(self._native.table())
        self._index = {name: position for position, name in enumerate(self._signals)}
        self._model: Optional[Model] = None

    # ---- What the log says of itself.

    @property
    def path(self) -> str:
        """As it was given."""
        return self._path

    @property
    def columns_file(self) -> Optional[str]:
        """Where the columns are kept; None: only as long as this object."""
        return self._native.columns_file or None

    @property
    def signals(self) -> Mapping[str, Signal]:
        """Every signal by name, in the order of the log, with kind, unit and words."""
        return dict(self._signals)

    @property
    def ticks(self) -> int:
        """Rows: the length of every array."""
        return int(self._native.rows)

    @property
    def duration(self) -> float:
        """s, from the first tick to the last."""
        return float(self._info["duration"])

    @property
    def time(self) -> Floats:
        """float64 of shape (ticks,), s of the tick clock."""
        return self["time"]

    @property
    def damage(self) -> List[str]:
        """What is damaged or missing, for people; empty for a sound log."""
        return list(self._info["damage"])

    @property
    def metadata(self) -> Mapping[str, str]:
        """Robot, scenario, seed, settings, plugins ...; what the end of the log says goes first."""
        return {**self._info["metadata"], **self._info["end_metadata"]}

    @property
    def events(self) -> List[Event]:
        """By tick."""
        return [Event(event["tick"], event["time"], event["kind"], event["text"]) for event in self._info["events"]]

    # ---- Values.

    def __getitem__(self, name: str) -> Array:
        """The values of a signal, shape (ticks,); its type is ``signals[name].dtype``.

        Raises :class:`MissingSignal`, a KeyError that names the nearest signal.
        """
        return self.read(name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._signals)

    def __len__(self) -> int:
        """How many signals there are; ``ticks`` is how many values each has."""
        return len(self._signals)

    def __contains__(self, name: object) -> bool:
        return name in self._signals

    def __repr__(self) -> str:
        return f"<gaitd.Log {self._path!r}: {self.ticks} ticks, {self.duration:.3f} s, {len(self)} signals>"

    def read(self, name: str, *, rows: slice = slice(None)) -> Array:
        """As ``log[name][rows]``, but reads only the blocks with those rows. The step must be positive."""
        if not isinstance(name, str):
            raise TypeError(f"log[{name!r}]: expected the name of a signal; a row of one is log['icp/x'][3]")
        if name not in self._signals:
            raise missing(name, list(self._signals))
        wanted = self._wanted(rows)
        start, count, step = wanted.start, len(wanted), wanted.step
        try:
            values = self._native.read(self._index[name], start, count, step)
        except RuntimeError as error:
            raise LogError(str(error)) from None
        return self._signals[name].convert(values)

    def _wanted(self, rows: slice) -> range:
        if not isinstance(rows, slice):
            raise TypeError(f"rows={rows!r}: expected a slice, for example slice(0, 1000) or log.rows_between(2, 3)")
        wanted = range(*rows.indices(self.ticks))
        if wanted.step < 1:
            raise ValueError(f"step {wanted.step}: expected a positive one")
        return wanted

    def match(self, *patterns: str) -> List[str]:
        """Names of the signals that the globs match, in their order; ``*`` matches slashes too.

        Raises :class:`MissingSignal` for a glob that matches none.
        """
        return choose(self._signals, patterns)

    def rows_between(self, start: Optional[float] = None, end: Optional[float] = None, every: int = 1) -> slice:
        """Rows with start <= time <= end (s), every so many of them, for ``read`` and the like."""
        for name, value in (("start", start), ("end", end)):
            if value is not None and np.isnan(value):
                raise ValueError(f"{name}={value}: expected a time in s, or None")
        if every < 1:
            raise ValueError(f"every={every}: expected at least 1")
        time = self.time
        first = 0 if start is None else int(np.searchsorted(time, start, "left"))
        last = self.ticks if end is None else int(np.searchsorted(time, end, "right"))
        return slice(first, last, every)

    def frame(self, signals: Union[str, Sequence[str]], *, rows: slice = slice(None)) -> "pandas.DataFrame":
        """A pandas frame of the signals that the globs match, indexed by time (s).

        Reals are float64, booleans bool, enumerations categories of their words, integers int64 (Int64 with NA where
        the log has no number). Raises :class:`MissingSignal` for a glob that matches none.
        """
        import pandas

        names = choose(self._signals, [signals] if isinstance(signals, str) else signals)
        columns = {name: self._column(pandas, name, rows) for name in names}
        return pandas.DataFrame(columns, index=pandas.Index(self.read("time", rows=rows), name="time"), copy=False)

    def _column(self, pandas: Any, name: str, rows: slice) -> Any:
        values = self.read(name, rows=rows)
        signal = self._signals[name]
        if signal.kind == "enumeration":
            return pandas.Categorical.from_codes(values, categories=list(signal.words))
        if signal.kind == "integer" and (values == np.iinfo(np.int64).min).any():
            return pandas.arrays.IntegerArray(values, values == np.iinfo(np.int64).min)
        return values

    # ---- The robot.

    @property
    def model(self) -> Model:
        """The robot of the log. Raises :class:`LogError` if the log holds none."""
        if self._model is None:
            self._model = Model(self.metadata)
        return self._model

    def poses(self, link: str, *, base: str = "estimate", rows: slice = slice(None)) -> Floats:
        """Poses of a link of the URDF: homogeneous matrices of shape (rows, 4, 4), link in world, m.

        base: ``"estimate"`` places the pelvis where gaitd estimated it, ``"truth"`` where the simulation had it. The
        joints are those measured. Raises :class:`MissingSignal` for a link or a base that is not there.
        """
        prefix = {"estimate": "pelvis/", "truth": "truth/pelvis/"}.get(base)
        if prefix is None:
            raise ValueError(f"base={base!r}: expected 'estimate' or 'truth'")
        names = [prefix + part for part in _POSE]
        names += [f"joint/{joint.name}/position" for joint in self.model.joints]
        wanted = self._wanted(rows)
        result = np.empty((len(wanted), 4, 4))
        for begin in range(0, len(wanted), _ROWS_AT_ONCE):
            part = wanted[begin : begin + _ROWS_AT_ONCE]
            values = np.stack([self.read(name, rows=slice(part.start, part.stop, part.step)) for name in names], 1)
            result[begin : begin + len(part)] = self.model.poses(link, values[:, :6], values[:, 6:])
        return result

    def positions(
        self,
        link: str,
        point: Tuple[float, float, float] = (0.0, 0.0, 0.0),
        *,
        base: str = "estimate",
        rows: slice = slice(None),
    ) -> Floats:
        """Where a point of a link is in the world: shape (rows, 3), m. point: in the frame of the link, m."""
        return placed(self.poses(link, base=base, rows=rows), point)

    # ---- Judgement.

    def verdict(self) -> Verdict:
        """What the log shows, judged by what its scenario expected: reads the whole log again.

        A damaged log does not pass, whatever is left of it shows.
        """
        try:
            verdict = Verdict.of(json.loads(_native.verdict(self._path)))
        except RuntimeError as error:
            raise LogError(str(error)) from None
        return replace(verdict, passed=verdict.passed and not self.damage)
