# `gaitctl teleop` on a terminal of 80 x 24: keys walk the robot, letting go stops it, Esc is the e-stop, and the
# terminal is as before when it ends.
source "$(dirname "$0")/common.sh"
command -v tmux >/dev/null || { echo "no tmux; install the packages of cmake/debian-packages.txt"; exit 77; }

terminal() { command tmux -S "$scratch/tmux" -f /dev/null "$@"; }
trap 'terminal kill-server 2>/dev/null || true; clean_up' EXIT
shown() { terminal capture-pane -p -t teleop; }
keys() { terminal send-keys -t teleop "$@"; }
# until_true SECONDS WHAT COMMAND...: it comes true.
until_true() {
  local deadline=$((SECONDS + $1)) what=$2
  shift 2
  until "$@"; do
    ((SECONDS < deadline)) || fail "$what: $(shown 2>/dev/null)"
    sleep 0.1
  done
}
shows() { shown | grep -qE -- "$1"; }
see() { until_true 20 "the screen does not show '$1'" shows "$1"; }
has_text() { [[ -s $1 ]]; }
pelvis_x() { gaitctl --json status | tr -d '\n ' | sed -E 's/.*"pelvis":\{"x":([-0-9.e]+).*/\1/'; }
is_beyond() { awk -v x="$(pelvis_x)" -v least="$1" 'BEGIN { exit !(x > least) }'; }
is_in_state() { [[ $(field state) == "$1" ]]; }
# hold KEY COMMAND...: as a keyboard that repeats, until the command comes true, and while it looks.
hold() {
  local key=$1 deadline=$((SECONDS + 60)) presser
  shift
  while keys "$key"; do sleep 0.05; done &
  presser=$!
  until "$@"; do
    ((SECONDS < deadline)) || {
      kill "$presser"
      fail "holding $key does not lead to '$*': $(shown)"
    }
    sleep 0.1
  done
  kill "$presser"
  wait "$presser" 2>/dev/null || true
}
# start ARGUMENTS...: teleop in a shell of its own; `ends CODE` waits for it and compares the terminal.
start() {
  rm -f "$scratch/code" "$scratch/before" "$scratch/after"
  keys "clear; stty -a >$scratch/before; $*; echo \$? >$scratch/code; stty -a >$scratch/after" Enter
  until_true 20 "the shell does not begin" has_text "$scratch/before"
  sleep 0.3  # what stood there before is off the screen
}
ends() {
  until_true 30 "teleop does not end" has_text "$scratch/after"
  [[ $(cat "$scratch/code") == "$1" ]] || fail "exit code $(cat "$scratch/code"), expected $1: $(shown)"
  cmp "$scratch/before" "$scratch/after" || fail "the terminal is not as before"
}

# Without a keyboard nothing would stop the robot.
expect 1 gaitctl teleop </dev/null 2>"$scratch/err"
grep -q 'gaitctl drive' "$scratch/err" || fail "it does not say what to take: $(cat "$scratch/err")"

terminal new-session -d -s teleop -x 80 -y 24 env -u NO_COLOR bash --norc --noprofile
start gaitctl teleop
ends 3
see 'no gaitd can be reached'
start gaitctl teleop --gamepad /dev/null
ends 1
see 'no input device|without libevdev'

start_daemon --log "$scratch/log.mcap"
wait_for state standing 20
expect 0 gaitctl mode stand

# Forwards, and to a stand.
start gaitctl teleop
see 'hold a key to walk'
see '^ICP margin +[+-][0-9]+ mm +error +[0-9]+ mm'
see '^faults +none'
before=$(pelvis_x)
hold w is_in_state walking
hold w is_beyond "$(awk -v x="$before" 'BEGIN { print x + 0.3 }')"
[[ $(field mode) == walk-straight* ]] || fail "mode: $(gaitctl status)"
hold w shows '^asked +\+0.30 m/s'
hold w shows '^real +\+0\.[0-9]+ m/s'
# Nothing is wider than the window, or has lost its place.
[[ $(shown | head -n 1) == 'gaitctl teleop '*'speed 100 %' ]] || fail "the first line: $(shown)"
(($(shown | LC_ALL=C.UTF-8 wc -L) <= 80)) || fail "a line is wider than the window: $(shown)"
(($(shown | grep -c '^state ') == 1)) || fail "the screen holds two pictures: $(shown)"
wait_for state standing 30

see 'hold a key to walk'

# Somebody else takes the robot over, and keeps it.
hold Up is_in_state walking
# A key that stutters, on a busy machine, at the very moment of the take-over begins a drive anew and keeps the
# robot: then the other one tries again.
other=
taken() {
  shows 'taken the robot over' && return
  [[ -n $other ]] && kill -0 "$other" 2>/dev/null || {
    gaitctl drive --forward 0.1 --for 3 >"$scratch/drive" 2>&1 &
    other=$!
  }
  false
}
hold Up taken
wait "$other" || fail "the other one was disturbed: $(cat "$scratch/drive")"
wait_for state standing 30
sleep 1.2
see 'hold a key to walk'

# The e-stop, and back.
hold d is_in_state walking
keys Escape
until_true 10 "Esc is no e-stop" is_in_state fault
see '^faults +estop'
[[ $(field faults) == estop ]] || fail "faults: $(field faults)"
keys r
until_true 10 "r does not reset" is_in_state disarmed
see 'm arms it'
expect 0 gaitctl sim reset >/dev/null  # it has fallen
wait_for state standing 30

# An arrow in pieces is none of it.
see 'hold a key to walk'
keys -H 1b 5b
sleep 0.3
keys -H 41
until_true 10 "an arrow in two pieces does not walk" is_in_state walking
wait_for state standing 30

# gaitd goes and comes back.
stop_daemon
see 'no connection to gaitd'
start_daemon --log "$scratch/log-2.mcap"
wait_for state standing 20
see 'connected to gaitd again'
see 'hold a key to walk'
hold w is_in_state walking
keys x
ends 0
wait_for state standing 30

# Lines where nothing stays in place, and no colours where none are wanted.
start env TERM=dumb gaitctl teleop
see 'hold a key to walk'
keys +
sleep 0.5
keys C-c
ends 0
for signal in TERM HUP INT; do
  start "NO_COLOR=1 sh -c 'echo \$\$ >$scratch/pid; exec gaitctl teleop'"
  see 'hold a key to walk'
  kill -"$signal" "$(cat "$scratch/pid")"
  ends 0
done

# The terminal goes while a key is held.
start gaitctl teleop
see 'hold a key to walk'
hold w is_in_state walking
terminal kill-server
wait_for state standing 30
[[ $(field faults) == none ]] || fail "faults: $(field faults)"
stop_daemon
