# gaitctl: 0 done, 1 refused or failed, 2 usage, 3 no daemon; for each command where it can occur.
# gaitd: 0 done, 1 failed, 2 usage.
source "$(dirname "$0")/common.sh"

# expect_all CODE ARGUMENTS: gaitctl with each line of standard input.
expect_all() {
  local line words
  while read -r line; do
    read -ra words <<<"$line"
    expect "$1" gaitctl "${words[@]}" >/dev/null 2>"$scratch/err"
    [[ $1 == 0 || -s $scratch/err ]] || fail "gaitctl $line: no message"
  done
}
# says TEXT: the last message has it.
says() { grep -qF -- "$1" "$scratch/err" || fail "no '$1' in: $(cat "$scratch/err")"; }

cat >"$scratch/steps.yaml" <<STEPS
- {side: right, x: 0.1, y: -0.113}
- {side: left, x: 0.1, y: 0.113}
STEPS
printf -- '- {side: right, x: 0.1, y: -0.113}\n- {side: left, x: far}\n' >"$scratch/wrong.yaml"
printf 'not a log' >"$scratch/bad.mcap"

# What needs a daemon, right as a command line.
needs_daemon="status
watch
watch --once
arm
disarm
estop
reset
mode walk-bent
steps $scratch/steps.yaml
walk --steps 2
pause
resume
stop
abort
plugin list
plugin swap toe_off never
plugin rollback toe_off
param list
param get gait.swing_duration
param set gait.swing_duration 0.7
sim push --link utorso --force 5,0,0 --duration 0.1
sim reset"
# And what does not.
alone="run stand
log info x.mcap
log export x.mcap
completion bash"

expect 0 gaitctl --help >/dev/null
expect 0 gaitctl --version
expect_all 3 <<<"$needs_daemon"
# An option that nobody has, behind every command; and what is missing or no value at all.
expect_all 2 < <(sed 's/$/ --nonsense/' <<<"$needs_daemon"$'\n'"$alone")
expect 2 gaitctl 2>/dev/null
expect_all 2 <<<"no-such-command
walk
walk --steps none
walk --steps 0
walk --steps 2 --first both
mode
mode run
steps
watch --interval 0
plugin
plugin swap toe_off
plugin swap no_such_layer never
plugin rollback
param
param get
param set gait.swing_duration
sim
sim push --link utorso --force 1,0 --duration 0.1
sim push --link utorso --force 1,0,0 --duration 0
log
log info
log export
log replay
compare
compare stand one.yaml
log export --json $scratch/bad.mcap
run
run a b --log one.mcap
completion
completion tcsh
--socket"
expect_all 1 <<<"run no-such-scenario
run stand --set duration=0.5 --set no.such.key=1 --log $scratch/bad-key.mcap
log info $scratch/none.mcap
log info $scratch/bad.mcap
log export $scratch/bad.mcap
steps $scratch/none.yaml
steps $scratch/wrong.yaml"
says "wrong.yaml:2: footsteps[1].x"
expect_all 0 <<<"run stand --set duration=2 --log $scratch/stand.mcap
log info $scratch/stand.mcap
log info --signals $scratch/stand.mcap
log export $scratch/stand.mcap --signals time -o $scratch/stand.csv
completion bash
completion zsh
completion fish"
expect 1 gaitctl log export "$scratch/stand.mcap" --signals 'no/*' 2>"$scratch/err"
says "log info --signals"

# A scenario with a command that is refused: the verdict depends on whether it says so.
refused() {
  cat <<SCENARIO
schema: gaitd.scenario/1
name: refused
robot: atlas
duration: 0.6
mode: walk-bent
commands: [{at: 0.5, walk: {steps: 1, length: 1.9}}]
expect: {no_fall: true$1}
SCENARIO
}
refused '' >"$scratch/refused.yaml"
refused ', refused_commands: 1' >"$scratch/expected.yaml"
expect 1 gaitctl run "$scratch/refused.yaml" --log "$scratch/refused.mcap"
expect 0 gaitctl run "$scratch/expected.yaml" --log "$scratch/refused.mcap"

# Sockets that lead nowhere.
expect 3 gaitctl --socket "$scratch/none.sock" status 2>"$scratch/err"
says "no such socket"
expect 3 gaitctl --socket "$scratch/bad.mcap" status 2>"$scratch/err"
says "not a socket"

expect 0 gaitd --help >/dev/null
expect 0 gaitd --version
expect 0 gaitd --check-config
expect 0 gaitd --scenario stand --clock lockstep --set duration=0.2 --log "$scratch/x.mcap"
# The gaitd.yaml of a robot's service: what simulates does not take it, and a scenario moves no robot.
mkdir -p "$scratch/service/etc"
printf 'schema: gaitd.config/1\nbackend: socketcan\n' >"$scratch/service/etc/gaitd.yaml"
GAITD_PATH=$scratch/service expect 0 gaitctl run stand --set duration=0.2 --log "$scratch/x.mcap"
GAITD_PATH=$scratch/service expect 1 gaitd --scenario stand --clock lockstep >"$scratch/err" 2>&1
says "a scenario plays in a simulation"
expect 2 gaitd --no-config --config etc/gaitd.yaml
expect 2 gaitd --clock sundial
expect 2 gaitd --nonsense
expect 2 gaitd stray
expect 1 gaitd --robot no-such-robot
expect 1 gaitd --scenario no-such-scenario
expect 1 gaitd --config "$scratch/none.yaml"
expect 1 gaitd --set no.such.key=1 --check-config
expect 1 gaitd --log "$scratch/no/such/folder.mcap"
expect 1 gaitd --socket "$scratch/no/such/folder.sock" --log "$scratch/x.mcap"

start_daemon --clock realtime --log "$scratch/log.mcap"
socket=$XDG_RUNTIME_DIR/gaitd.sock
wait_for state standing 20
expect 1 gaitd --log "$scratch/second.mcap" # the socket is taken
expect 0 gaitctl status
expect 0 gaitctl --json status >/dev/null
if ((EUID == 0)) && command -v setpriv >/dev/null; then
  # Another user may not.
  chmod 711 "$scratch" "$XDG_RUNTIME_DIR"
  expect 3 setpriv --reuid 65534 --regid 65534 --clear-groups \
    gaitctl --socket "$socket" status 2>"$scratch/err"
  says "permission denied"
fi
expect_all 0 < <(grep -vE '^(watch|disarm|estop|reset|arm|sim reset)$' <<<"$needs_daemon")
expect 0 gaitctl sim reset
wait_for state standing 20
expect_all 1 <<<"walk --steps 1 --length 1.9
walk --steps 100000
sim push --link no_such_link --force 1,0,0 --duration 0.1
plugin swap toe_off no_such_variant
plugin swap toe_off $scratch/none.so
plugin rollback step_adjuster
param get no.such.parameter
param set gait.swing_duration 1000"
for command in stop abort resume reset; do
  expect 0 gaitctl "$command" >"$scratch/err"
  says "nothing to"
done
expect 0 gaitctl disarm
expect_all 1 <<<"walk --steps 1
pause
resume
steps $scratch/steps.yaml"
expect 0 gaitctl arm
wait_for state standing 20
expect 0 gaitctl estop
expect_all 1 <<<"walk --steps 1
arm
disarm"
[[ $(field state) == fault ]] || fail "state is '$(field state)' after estop"
expect 0 gaitctl reset
[[ $(field state) == disarmed ]] || fail "state is '$(field state)' after reset"
kill -KILL "$daemon"
wait "$daemon" 2>/dev/null || true
daemon=
expect 3 gaitctl status 2>"$scratch/err" # the socket is still there
says "nobody listens"
expect_all 3 <<<"$needs_daemon"
