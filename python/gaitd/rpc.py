"""A connection to gaitd: one JSON object per line. What the methods take and give is in docs/protocol.md."""

from __future__ import annotations

import json
import socket
import time
from typing import Any, Dict, Iterator, Optional

from . import _native
from .errors import NoDaemon, Refused
from .plain import plain

__all__ = ["Connection"]


class Connection:
    """Requests to gaitd, one at a time, or the messages of a subscription. Not for several threads at once.

    The C++ client finds the socket and decides whether whoever listens there is to be believed.
    """

    def __init__(self, path: str = "", role: str = "command"):
        try:
            descriptor, self.path = _native.connect(path, role)
        except RuntimeError as error:
            raise NoDaemon(str(error)) from None
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM, fileno=descriptor)
        self._received = bytearray()
        self._next_id = 0

    def close(self) -> None:
        """Ends it; a second time does nothing."""
        self._socket.close()

    def call(self, method: str, params: Optional[Dict[str, Any]] = None, timeout: float = 10.0) -> Any:
        """The result of a request. Raises Refused for an error, NoDaemon if no answer comes within timeout (s)."""
        self._next_id += 1
        request: Dict[str, Any] = {"jsonrpc": "2.0", "id": self._next_id, "method": method}
        if params is not None:
            request["params"] = params
        deadline = time.monotonic() + timeout
        try:
            self._socket.settimeout(timeout)
            self._socket.sendall(json.dumps(plain(request), allow_nan=False).encode() + b"\n")
        except OSError as error:
            raise NoDaemon(f"{self.path}: cannot send to gaitd: {error}") from None
        while True:
            answer = self._message(deadline)
            if answer is None:
                raise NoDaemon(f"{self.path}: gaitd did not answer {method} within {timeout:g} s")
            # An error that names no request is of this one: no other waits.
            if "method" in answer or answer.get("id") not in (self._next_id, None):
                continue
            if "error" in answer:
                refusal = answer["error"]
                raise Refused(refusal["message"], refusal["code"], refusal.get("data"))
            return answer["result"]

    def notifications(self, timeout: Optional[float] = None) -> Iterator[Dict[str, Any]]:
        """What a subscription sends, as it comes; ends when nothing came for timeout (s). None: never."""
        while True:
            message = self._message(None if timeout is None else time.monotonic() + timeout)
            if message is None:
                return
            if "method" in message:
                yield message

    def _message(self, deadline: Optional[float]) -> Optional[Dict[str, Any]]:
        """The next line; None when the time is over."""
        searched = 0
        while (end := self._received.find(b"\n", searched)) < 0:
            searched = len(self._received)
            left = None if deadline is None else deadline - time.monotonic()
            if left is not None and left <= 0:
                return None
            try:
                self._socket.settimeout(left)
                received = self._socket.recv(1 << 16)
            except (TimeoutError, socket.timeout):  # one class from Python 3.10 on
                return None
            except OSError as error:
                raise NoDaemon(f"{self.path}: the connection broke: {error}") from None
            if not received:
                raise NoDaemon(f"{self.path}: gaitd closed the connection; see its log or journalctl -u gaitd")
            self._received += received
        line = bytes(self._received[:end])
        del self._received[: end + 1]
        try:
            message = json.loads(line)
        except ValueError:
            message = None
        if not isinstance(message, dict):
            raise NoDaemon(f"{self.path}: what listens on the socket does not speak the protocol of gaitd")
        return message
