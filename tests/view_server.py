# SPDX-License-Identifier: Apache-2.0
"""What `gaitctl view` serves, asked as a browser and as an attacker would; no page is needed.
view_server.py ADDRESSES: the file into which `gaitctl --json view` has printed them."""
import json
import re
import statistics
import sys
import time

from view_client import Refused, Viewer, get, request

pages = json.load(open(sys.argv[1]))
port = int(re.match(r"http://127\.0\.0\.1:(\d+)/#token=", pages["observe"]).group(1))
token = {role: page.split("=")[1] for role, page in pages.items()}


def check(holds, what):
    if not holds:
        sys.exit(f"FAILED: {what}")


def refused(status, what, **arguments):
    try:
        Viewer(port, **arguments)
    except Refused as refusal:
        check(refusal.status == status, f"{what}: status {refusal.status}, expected {status}")
        return
    sys.exit(f"FAILED: {what}: let in")


# ---- The page, and who may have what.
status, head, body = get(port, "/")
check(status == 200 and b"<html" in body, f"the page: {status}")
check("default-src 'none'" in head, "the page has no policy")
check(get(port, "/report/1")[0] == 401, "a report without a token")
check(get(port, "/report/1", [f"Authorization: Bearer {token['observe']}"])[0] == 404, "no such report")
check(get(port, "/../../etc/passwd")[0] == 404, "a path outside")
check(get(port, "/", host="evil.example:80")[0] == 421, "a foreign host")
refused(401, "a wrong token", token="0" * 32)
refused(401, "no token", token="")
refused(403, "a foreign origin", token=token["administer"], origin="http://evil.example")
refused(403, "the same port, another name", token=token["administer"], origin=f"http://evil.example:{port}")
refused(403, "a page that hides its origin", token=token["administer"], origin="null")
refused(401, "a page of a file, which has no token", token="", origin="file://")
refused(421, "a name that was rebound", token=token["administer"], host="evil.example", origin="http://evil.example")
refused(400, "another path", token=token["administer"], path="/other")
connection, status, _, _ = request(port, ["POST / HTTP/1.1", f"Host: 127.0.0.1:{port}", "Content-Length: 0"])
check(status == 405, f"POST: {status}")

# ---- The stream.
driver = Viewer(port, token["administer"], origin=f"http://127.0.0.1:{port}")
check(driver.until(lambda m: m.get("type") == "hello", "hello")["role"] == "administer", "role")
robot = driver.until(lambda m: m.get("type") == "robot" and m["connected"], "the robot")
check(robot["name"] == "atlas" and "<robot" in robot["urdf"] and robot["simulation"] is True, "the robot")
driver.until(lambda m: m.get("type") == "status" and m["status"]["state"] == "standing", "standing")
driver.frames.clear()
driver.watch(3)
check(len(driver.frames) > 90, f"{len(driver.frames)} frames in 3 s")
check(len(driver.frames[-1][3]) == len(driver.signals), "a value for each signal")
check(0.5 < driver.value("pelvis/z") < 1.2, f"pelvis at {driver.value('pelvis/z')}")
ticks = [frame[2] for frame in driver.frames]
check(ticks == sorted(set(ticks)), "each tick once, in their order")

# ---- Roles: the address decides, not what the user of `view` may do.
watcher = Viewer(port, token["observe"])
for method, params in [("walk", {"steps": 2, "length": 0.2}), ("arm", None), ("sim.push", {}),
                       ("plugin.swap", {"layer": "toe_off", "to": "never"}), ("no.such.method", None)]:
    answer = watcher.call(method, params)
    check(answer.get("error", {}).get("code") in (-32004, -32601), f"an observer's {method}: {answer}")
watcher.send({"type": "record", "on": True})
check("error" in watcher.until(lambda m: m.get("type") == "record", "record"), "an observer records")
walker = Viewer(port, token["command"])
driver.until(lambda m: m.get("type") == "viewers" and m["viewers"] == 3, "three viewers")
desktop = Viewer(port, token["observe"], origin="file://")
driver.until(lambda m: m.get("type") == "viewers" and m["viewers"] == 4, "a fourth, in a desktop program")
driver.messages.clear()
desktop.close()
driver.until(lambda m: m.get("type") == "viewers" and m["viewers"] == 3, "three again")
answer = walker.call("param.set", {"name": "safety.tilt_limit", "value": 1.5})
check(answer.get("error", {}).get("code") == -32004, f"a guarded parameter: {answer}")
answer = walker.call("sim.push", {"link": "utorso", "force": [1, 0, 0], "duration": 0.1})
check(answer.get("error", {}).get("code") == -32004, f"a push: {answer}")
check(watcher.call("status")["result"]["state"] == "standing", "status for an observer")
check(watcher.call("telemetry.subscribe", {"signals": ["*"]})["error"]["code"] == -32600, "a subscription")
walker.send({"method": 7, "id": 5})
check(walker.until(lambda m: m.get("id") == 5, "no method")["error"]["code"] == -32600, "no method")
walker._send(1, b"{not json")
walker._send(2, b"\x00" * 1000)  # binary means nothing from a browser
check(walker.call("status")["result"]["state"] == "standing", "still there after nonsense")

# ---- Walking, and a stalled viewer that costs nobody anything.
stalled = [Viewer(port, token["observe"]) for _ in range(3)]
viewers = [Viewer(port, token["observe"]) for _ in range(5)]
for viewer in viewers:
    viewer.send({"type": "rate", "hz": 30})
answer = walker.call("mode", {"mode": "walk-straight"})
check(answer.get("result", {}).get("accepted"), f"mode: {answer}")
answer = walker.call("walk", {"steps": 4, "length": 0.3})
check(answer.get("result", {}).get("accepted"), f"walk: {answer}")
start = driver.value("pelvis/x")
driver.frames.clear()
deadline = time.monotonic() + 60
while driver.frames == [] or driver.value("pelvis/x") < start + 1.0:
    driver.watch(0.2)
    for viewer in viewers:
        viewer.watch(0.01)
    check(time.monotonic() < deadline, "the robot does not walk")
gaps = [b[0] - a[0] for a, b in zip(driver.frames, driver.frames[1:])]
check(statistics.median(gaps) < 0.05, f"frames every {statistics.median(gaps)} s")
slower = Viewer(port, token["observe"])
slower.send({"type": "rate", "hz": 30})
slower.watch(1)
slower.frames.clear()
slower.watch(3)
rate = len(slower.frames) / 3
check(18 < rate < 36, f"asked for 30 frames a second, got {rate}")

# ---- A recording, and its report.
driver.send({"type": "record", "on": True})
driver.until(lambda m: m.get("type") == "record" and m["on"], "the recording")
driver.watch(0.5)
driver.frames.clear()
driver.messages.clear()
driver.watch(2)
check(len(driver.frames[-1][3]) == len(driver.signals), "the page's own signals while all are recorded")
check(len(driver.frames) < 130, f"{len(driver.frames)} frames in 2 s, of a page that draws 60 a second")
lost = sum(m["frames"] for m in driver.messages if m.get("type") == "lost")
check(lost < 30, f"{lost} frames count as lost, though they are not needed")
driver.messages.clear()
driver.send({"type": "record", "on": False})
done = driver.until(lambda m: m.get("type") == "record" and not m["on"], "its end", 60)
check(done.get("report"), f"no report: {done}")
status, _, body = get(port, done["report"], [f"Authorization: Bearer {token['command']}"])
check(status == 200 and b"gaitd-data" in body, f"the report: {status}")
print("recorded", done["log"])

# ---- Whoever watches may stop the robot.
answer = watcher.call("estop")
check(answer.get("result", {}).get("accepted"), f"estop: {answer}")
driver.messages.clear()
driver.until(lambda m: m.get("type") == "status" and "estop" in m["status"]["faults"], "the fault")
driver.until(lambda m: m.get("type") == "event" and m["event"]["kind"] == "fault", "its event")
for viewer in stalled:
    viewer.close()
check(walker.call("reset")["result"]["accepted"], "reset")
print("asked as a browser: all of it")
