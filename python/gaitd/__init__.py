"""gaitd from Python: command a robot, play scenarios and campaigns, read logs.

    import gaitd

    with gaitd.simulate(log="walk.mcap") as robot:      # or gaitd.connect() to one that runs
        robot.walk(6, length=0.3)
        robot.wait("standing")

    log = gaitd.Log("walk.mcap")
    log["icp/x"]                                        # numpy, one value per tick
    log.frame(["com/*", "gait/phase"])                  # pandas
    log.positions("l_hand")                             # of any link, m, world

    run = gaitd.run("flat-0.35", set={"seed": 2})       # run.passed, run.figures, run.log
    frame = gaitd.campaign("my.yaml")                   # a row per run

Units are SI and radians; the world has x forward and z up. Errors are :class:`GaitdError`. The page docs/python.md
leads through all of it.
"""

from ._native import version as __version__
from .campaigns import campaign, results
from .drive import Drive
from .errors import (
    DamagedLog,
    Fault,
    GaitdError,
    LogError,
    MissingSignal,
    NoDaemon,
    ProgramError,
    Refused,
    WaitTimeout,
)
from .height_map import HeightMap
from .log import Event, Log
from .model import Joint, Model
from .programs import find_program, write_yaml
from .robot import Robot, connect
from .scenarios import Run, run
from .signal_table import Signal
from .simulation import Simulation, simulate
from .verdict import Expectation, Verdict

__all__ = [
    "DamagedLog",
    "Drive",
    "Event",
    "Expectation",
    "Fault",
    "GaitdError",
    "HeightMap",
    "Joint",
    "Log",
    "LogError",
    "MissingSignal",
    "Model",
    "NoDaemon",
    "ProgramError",
    "Refused",
    "Robot",
    "Run",
    "Signal",
    "Simulation",
    "Verdict",
    "WaitTimeout",
    "__version__",
    "campaign",
    "connect",
    "find_program",
    "results",
    "run",
    "simulate",
    "write_yaml",
]
