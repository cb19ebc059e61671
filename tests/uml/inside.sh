# Sourced by the scripts that run inside User-Mode Linux. Most of their time would go into starting
# programs, which is dear in here: they start few, and leave judging to the script outside.
set -euo pipefail

fail() {
  printf 'FAILED: %s\n' "$*"
  for file in "$scratch"/gaitd.txt "$scratch"/robot.txt "$scratch"/arm.txt; do
    [[ -f $file ]] && tail -n 15 "$file" | sed "s|^|  $(basename "$file" .txt): |"
  done
  exit 1
}

# pause SECONDS: without a program.
exec {never}<> <(:)
pause() { read -rt "$1" -u "$never" || true; }

# can_links COUNT MTU: can0... as virtual buses, MTU 72 for FD and 16 for classic CAN.
can_links() {
  local i
  for ((i = 0; i < $1; ++i)); do
    [[ -e /sys/class/net/can$i ]] || echo "link add can$i type vcan"
    echo "link set can$i down"
    echo "link set can$i mtu $2 txqueuelen 32"
    echo "link set can$i up"
  done | ip -batch - || fail "no virtual buses"
}

# Whoever is woken by a frame waits until the sender has sent them all, instead of a switch each.
batch() { exec chrt --batch 0 "$@"; }
# Before a gaitd in real time, which waits for nobody: every command is answered at once.
at_once() { exec chrt --fifo 90 "$@"; }

# start_robot NAME ARGUMENTS...: the fake robot, which leaves NAME.json when it ends.
start_robot() {
  local said='' end=$((SECONDS + 60)) report=$scratch/$1.json
  shift
  "${robot_runs:-batch}" gaitd-fake-robot --report "$report" --stall-time "${stall_time:-60}" \
    --patience "${patience:-30}" "$@" >"$scratch/robot.txt" 2>&1 &
  robot=$!
  until { read -r said <"$scratch/robot.txt" && [[ $said == ready ]]; } 2>/dev/null; do
    kill -0 "$robot" 2>/dev/null || fail "the fake robot ended while starting"
    ((SECONDS < end)) || fail "the fake robot does not start"
    pause 0.02
  done
}

stop_robot() {
  kill -TERM "$robot"
  wait "$robot" || fail "the fake robot ended with $?"
}

# start_gaitd ARGUMENTS...: in lockstep with the fake robot unless $clock is realtime; ready when it
# answers.
start_gaitd() {
  batch gaitd --backend socketcan --clock "${clock:-lockstep}" --set log.enabled=false \
    --set socketcan.lockstep_timeout="${patience:-30}" \
    --set safety.ready_duration=0.5 "$@" >"$scratch/gaitd.txt" 2>&1 &
  gaitd=$!
  wait_status 150 '*"state":"*'
}

stop_gaitd() {
  kill -TERM "$gaitd"
  wait "$gaitd" || fail "gaitd ended with $?"
}

# wait_status SECONDS PATTERN: until the status, a line of JSON that is then in $status, matches. Only
# that line comes to bash, which asks the kernel for each byte of a pipe: it would fall behind for long.
# Without IFS, a piece that ends in a space keeps it.
wait_status() {
  local end=$((SECONDS + $1)) lines piece
  status=
  exec {lines}< <(watch_status "${2//\*/.*}")
  while ! IFS= read -rt 1 -u "$lines" piece; do
    status+=$piece
    ((SECONDS < end)) || fail "after $1 s, waiting for $2: $(gaitctl --json status 2>&1)"
    [[ -z ${gaitd-} ]] || kill -0 "$gaitd" 2>/dev/null || fail "gaitd ended, waiting for $2"
  done
  status+=$piece
  exec {lines}<&-
  # shellcheck disable=SC2053 # a pattern
  [[ $status == $2 ]] || fail "a fault, waiting for $2: $status"
}

# watch_status EXPRESSION: the first status that matches, or that tells of a fault. It begins anew
# where a busy machine lets the connection wait for too long.
watch_status() {
  local fault='"state":"fault"'
  [[ $1 == *fault* ]] && fault=$1
  set +o pipefail # grep ends first
  until gaitctl --json watch --reconnect --interval 0.1 2>/dev/null |
    busybox grep -m 1 -e "$1" -e "$fault"; do :; done
}

# wait_state STATE SECONDS
wait_state() { wait_status "$2" "*\"state\":\"$1\"*"; }

# wait_healthy: motors and buses are in order, and the e-stop has been heard.
wait_healthy() { wait_status 120 '*"healthy":true*'; }

# ask_status: $status as it is now.
ask_status() {
  status=$(gaitctl --json status) || fail "gaitd does not answer"
  status=${status//[[:space:]]/}
}

# arm_robot: `gaitctl arm`, again while a robot that has just come up has not been estimated yet.
arm_robot() {
  local answer end=$((SECONDS + 60))
  until answer=$(gaitctl --json arm 2>&1); do
    echo "$answer" >"$scratch/arm.txt"
    [[ $answer == *"no estimate yet"* ]] && ((SECONDS < end)) || return 1
    pause 0.1
  done
  rm -f "$scratch/arm.txt"
}

# refused TEXT: arming is refused, for this reason.
refused() {
  local answer
  answer=$(gaitctl arm 2>&1) && fail "armed, expected a refusal because of $1"
  [[ $answer == *"$1"* ]] || fail "refused with '$answer', expected $1"
}
