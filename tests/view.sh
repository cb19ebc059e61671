# `gaitctl view`: what it serves, to whom, and that it outlives its gaitd.
source "$(dirname "$0")/common.sh"
cd "$scratch"
if [[ ! -f $GAITD_BUILD/share/gaitd/view.html ]]; then
  echo "skipped: the page was not built, because npm or its registry was not there"
  exit 77
fi

expect 3 gaitctl view 2>none.txt
grep -q 'no gaitd can be reached' none.txt || fail "without a gaitd: $(cat none.txt)"
start_daemon --set clock=realtime --set log.enabled=false
expect 2 gaitctl view --listen nowhere 2>/dev/null
gaitctl --json view --listen 127.0.0.1:0 >pages.json 2>view.txt &
view=$!
for _ in {1..100}; do grep -q '}' pages.json && break || sleep 0.1; done
expect 0 python3 "$GAITD_SOURCE/tests/view_server.py" pages.json
expect 0 gaitctl log info gaitd-view-*.mcap >info.txt
grep -q 'atlas' info.txt || fail "the recording does not know its robot: $(cat info.txt)"

# gaitd goes and comes back: the page is told both.
expect 0 python3 - pages.json "$daemon" <<'PYTHON'
import json, os, signal, subprocess, sys, time
sys.path.insert(0, os.environ["GAITD_SOURCE"] + "/tests")
from view_client import Viewer
page = json.load(open(sys.argv[1]))["administer"]
viewer = Viewer(int(page.split(":")[2].split("/")[0]), page.split("=")[1])
viewer.until(lambda m: m.get("type") == "robot" and m["connected"], "the robot")
os.kill(int(sys.argv[2]), signal.SIGKILL)
gone = viewer.until(lambda m: m.get("type") == "robot" and not m["connected"], "gone")
assert gone["reason"], gone
answer = viewer.call("status")
assert answer["error"]["code"] == -32003 and "gaitd" in answer["error"]["message"], answer
viewer.messages.clear()
again = subprocess.Popen(["gaitd", "--set", "clock=realtime", "--set", "log.enabled=false"],
                         stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
viewer.until(lambda m: m.get("type") == "robot" and m["connected"], "back", 60)
assert "result" in viewer.call("status")
viewer.frames.clear()
viewer.watch(1)
assert viewer.frames, "no frames afterwards"
again.terminate()
assert again.wait(30) == 0
PYTHON
daemon=
kill -TERM "$view"
code=0
wait "$view" || code=$?
((code == 0)) || fail "view ended with $code on SIGTERM: $(cat view.txt)"
