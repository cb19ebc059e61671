# Within a tick nothing is allocated, no page is met for the first time, and nothing can block: over a
# walk of a minute with a push, commands, parameters and two swaps, and in real time with clients.
source "$(dirname "$0")/common.sh"
cd "$scratch"
guard=$GAITD_BUILD/tests/rt_guard.so
export GAITD_RT_GUARD_WARM_UP=500

# clean NAME TICKS: what the guard counted.
clean() {
  cat "$1.json"
  grep -q '"memory": 0, "blocking": 0, "faults": 0}' "$1.json" || fail "$1: not clean"
  ticks=$(sed -E 's/.*"ticks": ([0-9]+).*/\1/' "$1.json")
  ((ticks >= $2)) || fail "$1: only $ticks ticks"
}
# guarded NAME SCENARIO: played by a gaitd with the guard.
guarded() {
  GAITD_RT_GUARD=$PWD/$1.json LD_PRELOAD=$guard gaitd --scenario "$2" --clock lockstep \
    --socket "$1.sock" --log "$1.mcap" >"$1.txt" 2>&1 || { cat "$1.txt"; fail "$1 does not run"; }
}

cat >walk.yaml <<'SCENARIO'
schema: gaitd.scenario/1
name: minute
robot: atlas
duration: 64
seed: 1
mode: walk-straight
sensors: {noise: nominal}
commands:
  - {at: 1.0, walk: {steps: 66, length: 0.3}}
  - {at: 6.0, param: {gait.swing_height: 0.12}}
  - {at: 8.0, swap: {layer: whole_body_controller, to: com_height_qp}}
  - {at: 14.0, swap: {layer: icp_planner, to: single_cmp}}
  - {at: 20.0, mode: walk-bent}
  - {at: 30.0, pause: true}
  - {at: 34.0, resume: true}
disturbances:
  - {link: utorso, force: [0, 60, 0], duration: 0.1, when: {time: 10.0}}
SCENARIO
guarded walk walk.yaml
clean walk 60000

# The guard sees what it has to see: an exception takes memory.
export GAITD_TEST_FAULT=3 GAITD_TEST_FAULT_TIME=0
cat >bad.yaml <<SCENARIO
schema: gaitd.scenario/1
name: bad
robot: atlas
duration: 2
seed: 1
mode: walk-bent
commands:
  - {at: 1.0, swap: {layer: toe_off, to: $GAITD_BUILD/tests/bad_plugins/toe_off.so}}
SCENARIO
guarded bad bad.yaml
grep -q '"memory": 0,' bad.json && fail "the guard does not see a layer that allocates: $(cat bad.json)"

# In real time, with clients that ask and command while the log is written.
export GAITD_RT_GUARD=$PWD/live.json
gaitd() { # in the subshell of start_daemon
  export LD_PRELOAD=$guard
  exec gaitd "$@"
}
start_daemon --clock realtime --log live.mcap
unset GAITD_RT_GUARD
wait_for state standing 60
expect 0 gaitctl walk --steps 10 --length 0.2
for _ in 1 2 3; do
  while kill -0 "$daemon" 2>/dev/null && gaitctl status >/dev/null 2>&1; do :; done &
done
expect 0 gaitctl plugin swap toe_off never
expect 0 gaitctl param set gait.swing_height 0.11
expect 0 gaitctl pause
expect 0 gaitctl resume
expect 0 gaitctl plugin rollback toe_off
expect 0 gaitctl stop
wait_for state standing 90
stop_daemon
wait
clean live 3000
