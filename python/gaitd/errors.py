"""What the package raises. Every error of gaitd is a :class:`GaitdError`."""

from __future__ import annotations

from typing import Any, List, Optional

__all__ = [
    "DamagedLog",
    "Fault",
    "GaitdError",
    "LogError",
    "MissingSignal",
    "NoDaemon",
    "ProgramError",
    "Refused",
    "WaitTimeout",
]


class GaitdError(Exception):
    """Base of all errors of this package."""


class LogError(GaitdError):
    """A file that is no log of gaitd or cannot be read, in the words of the reader."""


class DamagedLog(LogError):
    """A log that lacks something: cut off, or bytes that are not what was written.

    ``findings`` are the texts that ``gaitctl log info`` prints. ``Log(path, damaged="read")`` reads what is left.
    """

    def __init__(self, path: str, findings: List[str]):
        super().__init__(f"{path}: damaged: " + "; ".join(findings))
        self.findings = findings


class MissingSignal(GaitdError, KeyError):
    """No signal, link or figure of that name; the text names the nearest one."""

    def __str__(self) -> str:
        return str(self.args[0])


class NoDaemon(GaitdError, ConnectionError):
    """No gaitd can be reached, or it went away."""


class Refused(GaitdError):
    """gaitd refused a request.

    ``code`` and ``data`` are those of JSON-RPC (docs/protocol.md): -32602 for wrong parameters, -32000 for what the
    present state forbids; ``data["tick"]`` says when.
    """

    def __init__(self, message: str, code: int, data: Any = None):
        super().__init__(message)
        self.code = code
        self.data = data


class Fault(GaitdError):
    """The robot is in a fault; ``faults`` are their names (docs/safety.md)."""

    def __init__(self, faults: List[str], waited_for: str):
        super().__init__(f"fault ({', '.join(faults)}) while waiting for {waited_for}")
        self.faults = faults


class WaitTimeout(GaitdError, TimeoutError):
    """What was waited for did not come in time."""


class ProgramError(GaitdError):
    """gaitctl or gaitd could not do what was asked. ``exit_code`` as in docs/commands.md; None: not started."""

    def __init__(self, message: str, exit_code: Optional[int] = None):
        super().__init__(message)
        self.exit_code = exit_code
