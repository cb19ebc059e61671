"""A gaitd of one's own, with a simulated robot."""

from __future__ import annotations

import os
import subprocess
import tempfile
import time
import weakref
from typing import Any, Mapping, Optional, Union

from .errors import NoDaemon, ProgramError
from .programs import assignments, find_program
from .robot import Robot

__all__ = ["Simulation", "simulate"]

_PATIENCE = 20.0  # s for it to listen, and to end


def simulate(
    *,
    log: Union[str, "os.PathLike[str]", None] = None,
    robot: Optional[str] = None,
    backend: Optional[str] = None,
    clock: str = "realtime",
    set: Optional[Mapping[str, Any]] = None,  # as --set of gaitd
    trust: bool = False,
) -> "Simulation":
    """Starts a private gaitd with a simulated robot on flat ground, and gives the standing robot.

    >>> with gaitd.simulate(log="walk.mcap") as robot:
    ...     robot.walk(6, length=0.3)
    ...     robot.wait("standing")
    >>> log = gaitd.Log("walk.mcap")

    log: where to write it; None: no log. robot, backend: names, by default atlas in simbody. clock: ``"realtime"``, or
    ``"lockstep"``: simulated time goes as fast as the machine can. set: any keys of the configuration. trust: load
    libraries that robot.yaml names by path.

    Raises :class:`ProgramError` with what gaitd said where it does not start.
    """
    return Simulation(log, robot, backend, clock, set, trust)


def _terminate(process: "subprocess.Popen[bytes]") -> None:
    if process.poll() is None:
        process.terminate()
        try:
            process.wait(_PATIENCE)
        except subprocess.TimeoutExpired:
            process.kill()


class Simulation(Robot):
    """A :class:`Robot` of a gaitd that belongs to this object and ends with it."""

    def __init__(
        self,
        log: Union[str, "os.PathLike[str]", None],
        robot: Optional[str],
        backend: Optional[str],
        clock: str,
        set: Optional[Mapping[str, Any]],
        trust: bool,
    ):
        self._folder = tempfile.TemporaryDirectory(prefix="gaitd-")
        path = os.path.join(self._folder.name, "gaitd.sock")
        # Without the gaitd.yaml of a robot's service: its backend is the robot.
        command = [find_program("gaitd"), "--no-config", "--socket", path, "--clock", clock]
        command += ["--set", "log.enabled=false"] if log is None else ["--log", os.path.abspath(log)]
        command += [] if robot is None else ["--robot", robot]
        command += [] if backend is None else ["--backend", backend]
        command += ["--trust"] if trust else []
        self._output = os.path.join(self._folder.name, "gaitd.txt")
        with open(self._output, "wb") as output:
            self._process = subprocess.Popen(
                [*command, *assignments(set)], stdin=subprocess.DEVNULL, stdout=output, stderr=output
            )
        # However it is let go: a gaitd that nobody can reach any more would walk on and write its log.
        self._reaper = weakref.finalize(self, _terminate, self._process)
        try:
            self._connect(path)
            self.wait("standing", _PATIENCE)
        except BaseException:
            self._end()
            raise

    def _connect(self, path: str) -> None:
        deadline = time.monotonic() + _PATIENCE
        while True:
            if self._process.poll() is not None:
                raise ProgramError(f"gaitd did not start:\n{self.output}", self._process.returncode)
            try:
                return super().__init__(path)
            except NoDaemon:
                if time.monotonic() > deadline:
                    raise
            time.sleep(0.02)

    @property
    def output(self) -> str:
        """What this gaitd has printed so far."""
        with open(self._output, encoding="utf-8", errors="replace") as output:
            return output.read()

    def close(self) -> None:
        """Ends gaitd, which finishes its log. Raises :class:`ProgramError` if it did not end well."""
        if self._process.poll() is None:
            super().close()
        said = self._end()
        if self._process.returncode != 0 and said is not None:
            code = self._process.returncode
            raise ProgramError(f"gaitd ended with exit code {code}:\n{said}", code)

    def _end(self) -> Optional[str]:
        """What it printed; None if it was ended before."""
        if not os.path.exists(self._output):
            return None
        self._reaper()
        self._process.wait()
        said = self.output
        self._folder.cleanup()
        return said
