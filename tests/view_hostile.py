# SPDX-License-Identifier: Apache-2.0
"""Browsers that break every rule: none of them may end or stall `gaitctl view`.
view_hostile.py ADDRESSES PID: the addresses that it printed as JSON, and its process."""
import json
import os
import re
import socket
import sys
import time

from view_client import Refused, Viewer, get

pages = json.load(open(sys.argv[1]))
process = int(sys.argv[2])
port = int(re.match(r"http://127\.0\.0\.1:(\d+)/", pages["observe"]).group(1))
token = {role: page.split("=")[1] for role, page in pages.items()}
good = Viewer(port, token["command"])


def check(holds, what):
    if not holds:
        sys.exit(f"FAILED: {what}")


def still_there(what):
    """Frames and answers come to somebody else as ever."""
    good.frames.clear()
    good.watch(0.5)
    check(len(good.frames) > 10, f"{what}: {len(good.frames)} frames in 0.5 s")
    begin = time.monotonic()
    check("result" in good.call("status"), f"{what}: no status")
    check(time.monotonic() - begin < 2, f"{what}: a status took {time.monotonic() - begin} s")


def memory():
    return int(re.search(r"VmRSS:\s+(\d+)", open(f"/proc/{process}/status").read()).group(1)) / 1024


def ends(viewer, what, seconds=10):
    """The server closes this WebSocket."""
    try:
        viewer.connection.settimeout(seconds)
        while viewer.connection.recv(65536):
            pass
    except ConnectionError:
        pass
    except (TimeoutError, socket.timeout):
        sys.exit(f"FAILED: {what}: the connection stays")


good.until(lambda m: m.get("type") == "robot" and m["connected"], "the robot")
good.watch(0.5)
still_there("before")

# What is no WebSocket message, or none of those that are allowed.
def frame(first, size, payload=b""):
    return bytes([first, 0x80 | 127]) + size.to_bytes(8, "big") + bytes(4) + payload


for what, bytes_ in [("1 MB", frame(0x81, 1 << 20, b"x" * (1 << 20))),
                     ("a length of 2^62", frame(0x81, 1 << 62)),
                     ("a length beyond all", frame(0x82, (1 << 64) - 1)),
                     ("no UTF-8", frame(0x81, 4, b"\xff\xfe\xc0\x80")),
                     ("an unknown opcode", frame(0x8B, 0)),
                     ("bits that are reserved", frame(0xF1, 2, b"{}")),
                     ("no mask", b"\x81\x02{}"),
                     ("a ping of 1 MB", frame(0x89, 1 << 20, b"x" * (1 << 20)))]:
    viewer = Viewer(port, token["observe"])
    try:
        viewer.connection.sendall(bytes_)
    except ConnectionError:
        pass
    ends(viewer, what)
    still_there(what)

# What is JSON, and still none that is meant.
viewer = Viewer(port, token["observe"])
nested = b"[" * 30000 + b"]" * 30000
for text in [nested, b'{"method": "status", "id": 1, "params": ' + nested + b"}", b'{"a":' * 12000,
             b'{"method": "status", "id": ' + nested + b"}", b"null", b"[]", b'"text"', b"1e999", b'{"type": []}',
             b'{"type": "rate", "hz": "fast"}', b'{"type": "rate", "hz": -1e308}', b'{"type": "record", "on": {}}',
             b'{"method": "\\u0000", "id": {"a": [1]}}', b'{"method": "status", "id": "\\ud800"}']:
    viewer._send(1, text)
viewer.send({"type": "rate", "hz": 60})
check("result" in viewer.call("status"), "who has sent nonsense is not answered any more")
still_there("nonsense")

# Foxglove's protocol has messages of its own.
lines = ["GET /?token=" + token["observe"] + " HTTP/1.1", f"Host: 127.0.0.1:{port}", "Upgrade: websocket",
         "Connection: Upgrade", "Sec-WebSocket-Version: 13", "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==",
         "Sec-WebSocket-Protocol: foxglove.websocket.v1"]
foxglove = Viewer.__new__(Viewer)
foxglove.connection = socket.create_connection(("127.0.0.1", port), 10)
foxglove.connection.sendall("".join(line + "\r\n" for line in lines + [""]).encode())
check(b" 101 " in foxglove.connection.recv(1 << 16), "no Foxglove")
for text in [nested, b"{}", b'{"op": 7}', b'{"op": "subscribe"}', b'{"op": "subscribe", "subscriptions": [7, {"id": -1}]}',
             b'{"op": "subscribe", "subscriptions": 5}', b'{"op": "unsubscribe", "subscriptionIds": "x"}',
             b'{"op": "getParameters", "parameterNames": {"a": 1}, "id": ' + nested + b"}",
             b'{"op": "setParameters", "parameters": 3}', b'{"op": "setParameters", "parameters": [{}]}']:
    foxglove._send(1, text)
for bytes_ in [b"", b"\x02", b"\x02" + b"\xff" * 12, b"\x02" + bytes(12), b"\x02\x01" + bytes(3) + bytes(4) + b"\xff" * 4,
               b"\x02\x01" + bytes(11) + nested]:
    foxglove._send(2, bytes_)
still_there("nonsense of Foxglove")
viewer.close()
foxglove.connection.close()

# A flood of pings, and one of requests, whose answers nobody reads.
ping = bytes([0x89, 0x80]) + bytes(4)
request = b'{"jsonrpc":"2.0","id":1,"method":"param.list"}'
request = bytes([0x81, 0x80 | len(request)]) + bytes(4) + request
before = memory()
for what, message in [("pings", ping), ("requests", request)]:
    flooders = [Viewer(port, token["observe"]) for _ in range(3)]
    end = time.monotonic() + 2
    for flooder in flooders:
        flooder.connection.setblocking(False)
    sent = 0
    while time.monotonic() < end:
        for flooder in flooders:
            try:
                sent += flooder.connection.send(message * 200)
            except (BlockingIOError, ConnectionError):
                pass
        time.sleep(0.001)
    still_there(f"a flood of {what}, {sent / 1e6:.1f} MB")
    for flooder in flooders:
        flooder.close()

# Who goes on asking and reads nothing is dropped, without being asked to take a goodbye.
def descriptors():
    return len(os.listdir(f"/proc/{process}/fd"))


time.sleep(1)  # until those before are gone: it is counted who is left
open_before = descriptors()
deaf = Viewer(port, token["command"])
deaf.connection.setblocking(False)
end = time.monotonic() + 15  # before pings find out
while descriptors() > open_before:
    check(time.monotonic() < end, "who reads nothing stays")
    try:
        deaf.connection.send(request * 50)
    except (BlockingIOError, ConnectionError):
        pass
    time.sleep(0.02)
still_there("who reads nothing")
check(memory() < before + 150, f"memory went from {before:.0f} to {memory():.0f} MB")

# Handshakes that do not go on, and requests of all kinds.
half = [socket.create_connection(("127.0.0.1", port)) for _ in range(40)]
for i, connection in enumerate(half):
    connection.sendall([b"", b"GET /li", b"GET /live HTTP/1.1\r\nHost: 127.0.0.1\r\n", b"\x16\x03\x01\x02\x00\x01"][i % 4])
odd = []
for bytes_ in [b"\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", b"X" * 20000, b"GET / HTTP/1.1\r\n" + b"A: b\r\n" * 5000,
               b"GET " + b"/" * 9000 + b" HTTP/1.1\r\n\r\n", b"POST / HTTP/1.1\r\nContent-Length: 99999999999\r\n\r\n",
               b"GET / HTTP/1.1\r\nHost: [::1\r\n\r\n", b"GET /report/99999999999999 HTTP/1.1\r\nHost: localhost\r\n\r\n"]:
    odd.append(socket.create_connection(("127.0.0.1", port)))
    odd[-1].sendall(bytes_)
    odd[-1].settimeout(15)
for connection in odd:
    try:
        connection.recv(65536)
    except OSError:
        pass
    connection.close()
still_there("odd requests")

# More viewers than gaitd has connections, each of whom is answered; then more than there is room for.
crowd = [Viewer(port, token["observe"]) for _ in range(100)]
for viewer in crowd:
    viewer.send({"type": "rate", "hz": 1})
for viewer in crowd:
    check("result" in viewer.call("status"), "one of a hundred viewers is not answered")
still_there("a hundred viewers")
begin = time.monotonic()
check(crowd[-1].call("estop")["result"]["accepted"], "the hundredth cannot stop the robot")
check(time.monotonic() - begin < 2, f"its e-stop took {time.monotonic() - begin} s")
turned_away = 0
others = []
for _ in range(250):
    try:
        others.append(socket.create_connection(("127.0.0.1", port), 5))
    except OSError:
        turned_away += 1
still_there("more connections than there is room for")
for connection in others + half:
    connection.close()
for viewer in crowd:
    viewer.close()
for _ in range(100):
    try:
        Viewer(port, token["observe"]).close()
        break
    except (Refused, OSError):
        time.sleep(0.1)
else:
    sys.exit("FAILED: nobody is let in after the crowd has gone")
check(get(port, "/")[0] == 200, "the page")
still_there("afterwards")
check(good.call("reset")["result"]["accepted"], "reset")
print(f"outlived all of it, with {memory():.0f} MB")
