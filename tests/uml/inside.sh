# Sourced by the scripts that run inside User-Mode Linux.
set -euo pipefail

fail() {
  printf 'FAILED: %s\n' "$*"
  for file in "$scratch"/gaitd.txt "$scratch"/robot.txt; do
    [[ -f $file ]] && tail -n 15 "$file" | sed "s|^|  $(basename "$file" .txt): |"
  done
  exit 1
}

# can_links COUNT MTU: can0... as virtual buses, MTU 72 for FD and 16 for classic CAN.
can_links() {
  local i
  for ((i = 0; i < $1; ++i)); do
    ip link show "can$i" >/dev/null 2>&1 || ip link add "can$i" type vcan
    ip link set "can$i" down
    ip link set "can$i" mtu "$2" txqueuelen 32
    ip link set "can$i" up
  done
}

# Whoever is woken by a frame waits until the sender has sent them all, instead of a switch each.
batch() { exec chrt --batch 0 "$@"; }

# start_robot ARGUMENTS...: the fake robot, which leaves robot.json when it ends.
start_robot() {
  rm -f "$scratch/robot.json"
  batch gaitd-fake-robot --report "$scratch/robot.json" --stall-time "${stall_time:-60}" \
    --patience "${patience:-30}" "$@" >"$scratch/robot.txt" 2>&1 &
  robot=$!
  for _ in {1..3000}; do
    grep -q ready "$scratch/robot.txt" && return
    kill -0 "$robot" 2>/dev/null || fail "the fake robot ended while starting"
    sleep 0.02
  done
  fail "the fake robot does not start"
}

stop_robot() {
  kill -TERM "$robot"
  wait "$robot" || fail "the fake robot ended with $?"
}

# start_gaitd ARGUMENTS...: in lockstep with the fake robot, ready when it answers.
start_gaitd() {
  batch gaitd --backend socketcan --clock lockstep --set log.enabled=false \
    --set socketcan.lockstep_timeout="${patience:-30}" \
    --set safety.ready_duration=0.5 "$@" >"$scratch/gaitd.txt" 2>&1 &
  gaitd=$!
  for _ in {1..3000}; do
    gaitctl status >/dev/null 2>&1 && return
    kill -0 "$gaitd" 2>/dev/null || fail "gaitd ended while starting"
    sleep 0.05
  done
  fail "gaitd does not answer"
}

stop_gaitd() {
  kill -TERM "$gaitd"
  wait "$gaitd" || fail "gaitd ended with $?"
}

field() { gaitctl status | awk -v name="$1" '$1 == name { $1 = ""; print substr($0, 2) }'; }

# wait_state STATE SECONDS
wait_state() {
  local state end=$((SECONDS + $2))
  while state=$(field state); [[ $state != "$1" ]]; do
    [[ $state == fault && $1 != fault ]] && fail "fault $(field faults), waiting for $1"
    ((SECONDS < end)) || fail "state $state after $2 s, expected $1"
    sleep 0.3 # asking takes time from the one processor
  done
}

# expect_json FILE EXPRESSION...: python on the report `r`, started once for all of them.
expect_json() {
  python3 -S - "$@" <<'PYTHON' || fail "$1: see the expression above"
import json, sys
r = json.load(open(sys.argv[1]))
for expression in sys.argv[2:]:
    if not eval(expression):
        print("expected", expression)
        print(json.dumps(r))
        sys.exit(1)
PYTHON
}
