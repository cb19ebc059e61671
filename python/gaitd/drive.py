"""Walking at a velocity, which gaitd wants to be renewed."""

from __future__ import annotations

import os
import threading
import time
import weakref
from typing import Any, Dict, Optional

from .errors import GaitdError
from .rpc import Connection

__all__ = ["Drive"]

_RENEWAL = 0.1  # s; gaitd waits drive.timeout, 0.5 s unless configured otherwise


class Drive:
    """A robot that walks at a velocity until ``end``. Made by :meth:`Robot.drive`.

    >>> with robot.drive(forward=0.3) as drive:
    ...     drive.sleep(5)
    ...     drive.set(forward=0.3, turn=0.2)
    ...     drive.sleep(5)

    A thread of its own renews the velocity as long as this object lives, whatever the program does meanwhile: bound it
    with ``seconds`` of :meth:`Robot.drive` where the program may hang. If somebody else takes the robot over, or the
    robot faults, ``sleep``, ``set`` and ``end`` raise what gaitd said (:class:`Refused`).
    """

    def __init__(self, socket: str, forward: float, lateral: float, turn: float):
        self._connection = Connection(socket)
        self._session = int.from_bytes(os.urandom(6), "little")
        self._lock = threading.Lock()
        self._ended = threading.Event()
        self._over = False
        self._failure: Optional[BaseException] = None
        self._velocity = {"forward": forward, "lateral": lateral, "turn": turn}
        self.tick = -1  #: of the tick that took the last command
        self.note: Optional[str] = None  #: why it walks slower than asked, or None
        self._send(dict(self._velocity))
        # The thread holds the object only while it sends: dropped, it drives no longer.
        self._thread = threading.Thread(
            target=_renew, args=(weakref.ref(self), self._ended), name="gaitd-drive", daemon=True
        )
        self._thread.start()

    def __enter__(self) -> "Drive":
        return self

    def __exit__(self, kind: Any, *_: Any) -> None:
        try:
            self.end()
        except GaitdError:
            if kind is None:  # else what ended the block says more
                raise

    def set(self, forward: float = 0.0, lateral: float = 0.0, turn: float = 0.0) -> None:
        """Another velocity: m/s, m/s, rad/s."""
        self._check()
        with self._lock:
            velocity = {"forward": forward, "lateral": lateral, "turn": turn}
            self._send({**velocity, "renew": True})
            self._velocity = velocity

    def sleep(self, seconds: float) -> None:
        """Drives on for so long, s of this machine's clock."""
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > 0:
            self._check()
            self._ended.wait(min(left, _RENEWAL))

    def end(self) -> None:
        """Lets go: the robot comes to a stand. A second time does nothing."""
        if not self._over:
            self._over = True
            self._ended.set()
            self._thread.join()
            try:
                if self._failure is None:
                    self._send({"end": True})
            finally:
                self._connection.close()
        self._check()

    def _check(self) -> None:
        if self._failure is not None:
            raise self._failure

    def _send(self, params: Dict[str, Any]) -> None:
        answer = self._connection.call("drive", {**params, "session": self._session}, timeout=2.0)
        self.tick, self.note = answer["tick"], answer["note"]

    def _renew(self) -> None:
        try:
            with self._lock:
                self._send({**self._velocity, "renew": True})
        except BaseException as error:  # whatever it is, the robot is not driven any more
            self._failure = error
            self._ended.set()


def _renew(reference: "weakref.ref[Drive]", ended: threading.Event) -> None:
    while not ended.wait(_RENEWAL):
        drive = reference()
        if drive is None:
            return
        drive._renew()
        del drive
