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

view=
trap '[[ -z $view ]] || kill "$view" 2>/dev/null; clean_up' EXIT
# start_view ARGUMENTS...: in the background; pages.json has its addresses.
start_view() {
  gaitctl --json view "$@" >pages.json 2>view.txt &
  view=$!
  wait_until grep -q '}' pages.json || fail "view prints no address: $(cat view.txt)"
}

end_view() {
  local pid=$view
  view=
  stop_process view "$pid"
}

# To other machines: only by TLS, whose certificate stays, and only while nobody else knows its key.
for start in first second; do
  start_view --listen '[::]:0'
  expect 0 python3 "$GAITD_SOURCE/tests/view_tls.py" pages.json | tee "$start.txt"
  end_view
done
cmp -s first.txt second.txt || fail "another fingerprint after a restart: $(cat first.txt second.txt)"
chmod 644 "$HOME/.config/gaitd/view.pem"
expect 1 gaitctl view --listen 0.0.0.0:0 2>readable.txt
grep -q 'chmod 600' readable.txt || fail "a key that others can read: $(cat readable.txt)"
chmod 600 "$HOME/.config/gaitd/view.pem"

# What docs/view.md tells people to type prints addresses; at a port that is free.
mapfile -t commands < <(grep -E '^gaitctl (--json )?view' "$GAITD_SOURCE/docs/view.md" | grep -v -e --open)
((${#commands[@]} >= 5)) || fail "docs/view.md has only ${#commands[@]} commands"
for command in "${commands[@]}"; do
  [[ $command == *--listen* ]] || command+=' --listen 127.0.0.1:0'
  read -ra words <<<"${command/:8765/:0}"
  printf '$ %s\n' "${words[*]}"
  "${words[@]}" >shown.txt 2>view.txt &
  view=$!
  wait_until grep -q '#token=' shown.txt || true
  grep -qE 'https?://[^ ]+/#token=[0-9a-f]{32}' shown.txt || fail "no address: $(cat shown.txt view.txt)"
  if [[ $command == *--watch-only* && $(grep -c '#token=' shown.txt) != 1 ]]; then fail "not only to watch: $(cat shown.txt)"; fi
  end_view
done

start_view --listen 127.0.0.1:0
expect 0 python3 "$GAITD_SOURCE/tests/view_server.py" pages.json
expect 0 python3 "$GAITD_SOURCE/tests/view_hostile.py" pages.json "$view"
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
end_view
