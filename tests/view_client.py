# SPDX-License-Identifier: Apache-2.0
"""A browser's side of `gaitctl view` for tests: WebSocket (RFC 6455) on Python's own sockets."""
import base64
import json
import os
import socket
import struct
import time


class Refused(Exception):
    """The handshake ended with this HTTP status."""

    def __init__(self, status, body):
        super().__init__(f"{status} {body}")
        self.status = status


def request(port, lines, timeout=10):
    """Sends the lines of one HTTP request; the socket, the status and what came so far."""
    connection = socket.create_connection(("127.0.0.1", port), timeout)
    connection.sendall("".join(line + "\r\n" for line in lines + [""]).encode())
    data = b""
    while b"\r\n\r\n" not in data:
        part = connection.recv(65536)
        if not part:
            break
        data += part
    head, _, rest = data.partition(b"\r\n\r\n")
    words = head.split(b" ", 2)
    return connection, int(words[1]) if len(words) > 1 else 0, head.decode(), rest


def get(port, path, headers=(), host=None):
    """Status, headers and body of a GET."""
    lines = [f"GET {path} HTTP/1.1", f"Host: {host or f'127.0.0.1:{port}'}", "Connection: close", *headers]
    connection, status, head, body = request(port, lines)
    while part := connection.recv(65536):
        body += part
    connection.close()
    return status, head, body


class Viewer:
    def fileno(self):
        return self.connection.fileno()

    def __init__(self, port, token, origin=None, host=None, path="/live"):
        self.port = port
        lines = [f"GET {path} HTTP/1.1", f"Host: {host or f'127.0.0.1:{port}'}", "Upgrade: websocket",
                 "Connection: Upgrade", "Sec-WebSocket-Version: 13",
                 "Sec-WebSocket-Key: " + base64.b64encode(os.urandom(16)).decode(),
                 f"Sec-WebSocket-Protocol: gaitd.v1, token.{token}"]
        if origin:
            lines.append("Origin: " + origin)
        self.connection, status, _, self.data = request(port, lines)
        if status != 101:
            raise Refused(status, self.data.decode(errors="replace"))
        self.next_id = 1
        self.frames = []    # (when it came, time, tick, values)
        self.messages = []  # all that is text
        self.signals = []

    def close(self):
        self.connection.close()

    def _take(self, count, deadline):
        while len(self.data) < count:
            self.connection.settimeout(max(0.001, deadline - time.monotonic()))
            part = self.connection.recv(1 << 20)
            if not part:
                raise ConnectionError("the server closed")
            self.data += part
        taken, self.data = self.data[:count], self.data[count:]
        return taken

    def _send(self, opcode, payload):
        mask = os.urandom(4)
        head = bytes([0x80 | opcode])
        size = len(payload)
        head += bytes([0x80 | size]) if size < 126 else bytes([0xFE]) + struct.pack(">H", size)
        self.connection.sendall(head + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(payload)))

    def send(self, message):
        self._send(1, json.dumps(message).encode())

    def receive(self, seconds):
        """Takes one message within that time; False if none came."""
        deadline = time.monotonic() + seconds
        try:
            first, second = self._take(2, deadline)
            size = second & 127
            if size == 126:
                size = struct.unpack(">H", self._take(2, deadline + 5))[0]
            elif size == 127:
                size = struct.unpack(">Q", self._take(8, deadline + 5))[0]
            payload = self._take(size, deadline + 5)
        except (TimeoutError, socket.timeout):
            return False
        opcode = first & 15
        if opcode == 9:
            self._send(10, payload)
        elif opcode == 8:
            raise ConnectionError("the server said goodbye: " + payload[2:].decode(errors="replace"))
        elif opcode == 2:
            when, tick = struct.unpack("<dd", payload[:16])
            values = struct.unpack(f"<{(len(payload) - 16) // 4}f", payload[16:])
            self.frames.append((time.monotonic(), when, int(tick), values))
        elif opcode == 1:
            message = json.loads(payload)
            self.messages.append(message)
            if message.get("type") == "robot" and message["connected"]:
                self.signals = [signal["name"] for signal in message["signals"]]
        return True

    def watch(self, seconds):
        """Takes what comes in that time."""
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > 0:
            self.receive(left)

    def until(self, wanted, what, seconds=20):
        """Takes messages until one is wanted; that one. Those that came before count too."""
        deadline = time.monotonic() + seconds
        seen = 0
        while True:
            for message in self.messages[seen:]:
                if wanted(message):
                    return message
            seen = len(self.messages)
            if time.monotonic() > deadline:
                raise AssertionError(f"{what}: not within {seconds} s; last {self.messages[-2:]}")
            self.receive(0.2)

    def call(self, method, params=None):
        """The whole answer of a request."""
        self.next_id += 1
        message = {"jsonrpc": "2.0", "id": f"t{self.next_id}", "method": method}
        if params is not None:
            message["params"] = params
        self.send(message)
        return self.until(lambda m: m.get("id") == message["id"], method)

    def value(self, signal):
        return self.frames[-1][3][self.signals.index(signal)]
