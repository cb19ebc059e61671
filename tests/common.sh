# Sourced by every test script. GAITD_BUILD and GAITD_SOURCE name the build and the source tree.
# Gives: a temporary folder $scratch, gaitd and gaitctl on PATH, nothing of the user's environment.
set -euo pipefail

scratch=$(mktemp -d)
daemon=

fail() {
  printf 'FAILED: %s\n' "$*" >&2
  [[ -f $scratch/gaitd.txt ]] && sed 's/^/  gaitd: /' "$scratch/gaitd.txt" >&2
  exit 1
}

clean_up() {
  [[ -n $daemon ]] && kill -KILL "$daemon" 2>/dev/null
  rm -rf "$scratch"
}
trap clean_up EXIT

export PATH="$GAITD_BUILD/bin:$PATH"
export HOME=$scratch/home XDG_RUNTIME_DIR=$scratch/run
unset XDG_STATE_HOME GAITD_PATH
mkdir -p "$HOME" "$XDG_RUNTIME_DIR"

# expect CODE COMMAND...: runs it, shows what it does and checks its exit code.
expect() {
  local code=$1 got=0
  shift
  printf '$ %s\n' "$*"
  "$@" || got=$?
  ((got == code)) || fail "'$*' ended with exit code $got, expected $code"
}

# short_scenario SECONDS: a robot that stands for so long with bent knees, for campaigns of many runs.
short_scenario() {
  cat <<SCENARIO
schema: gaitd.scenario/1
name: short
robot: atlas
duration: $1
seed: 1
mode: walk-bent
sensors: {noise: nominal}
expect: {no_fall: true}
SCENARIO
}

# wait_until COMMAND...: until it succeeds; gives up after 1200 attempts: a minute at least, more than a busy machine
# needs.
wait_until() {
  local attempt
  for ((attempt = 0; attempt < 1200; ++attempt)); do
    "$@" && return
    sleep 0.05
  done
  return 1
}

# start_daemon ARGUMENTS...: gaitd in the background, ready when it answers.
start_daemon() {
  printf '$ gaitd %s &\n' "$*"
  gaitd "$@" >"$scratch/gaitd.txt" 2>&1 &
  daemon=$!
  answers_or_ended() { "${client[@]}" status >/dev/null 2>&1 || ! kill -0 "$daemon" 2>/dev/null; }
  wait_until answers_or_ended || fail "gaitd does not answer"
  kill -0 "$daemon" 2>/dev/null || fail "gaitd ended while starting"
}

# stop_process NAME PID [CODE]: on SIGTERM; CODE is the exit code expected.
stop_process() {
  local code=0
  kill -TERM "$2"
  wait "$2" || code=$?
  ((code == ${3:-0})) || fail "$1 ended with exit code $code on SIGTERM, expected ${3:-0}"
}

# stop_daemon [CODE]
stop_daemon() {
  local pid=$daemon
  daemon=
  stop_process gaitd "$pid" "${1:-0}"
}

# The client that every helper uses; a script may add --socket.
client=(gaitctl)

# field NAME: of `gaitctl status`.
field() { "${client[@]}" status | awk -v name="$1" '$1 == name { $1 = ""; print substr($0, 2) }'; }

# commands_of PAGE: the lines of its ```sh blocks.
commands_of() { awk '/^```sh$/ { on = 1; next } /^```/ { on = 0 } on' "$GAITD_SOURCE/$1"; }

# has_fault NAME: whether the status says so.
has_fault() { [[ $(field faults) == *"$1"* ]]; }

# interrupt_first_run COMMAND...: a campaign, until it plays or measures something.
interrupt_first_run() {
  "$@" &
  local campaign=$!
  plays_or_ended() { pgrep -P "$1" -x gaitctl >/dev/null || ! kill -0 "$1" 2>/dev/null; }
  wait_until plays_or_ended "$campaign" || true
  # A signal that comes before it listens is lost.
  has_ended_by_signal() { ! kill -INT "$1" 2>/dev/null; }
  wait_until has_ended_by_signal "$campaign" || kill -KILL "$campaign"
  wait "$campaign" || true
}

# wait_for NAME VALUE SECONDS: until the status says so. A fault ends it at once.
wait_for() {
  local value deadline=$((SECONDS + $3))
  while :; do
    value=$(field "$1")
    [[ $value == "$2" ]] && return
    [[ $(field state) == fault ]] && fail "fault ($(field faults)) while waiting for $1 $2"
    ((SECONDS < deadline)) || fail "$1 is '$value' after $3 s, expected '$2'"
    sleep 0.2
  done
}
