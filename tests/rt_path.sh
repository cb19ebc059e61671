# Within a tick nothing is allocated, no page is met for the first time, and nothing can block: over a
# walk of a minute with a push, commands and 140 swaps, and in real time, with clients. The torques
# take no step at a swap.
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
  GAITD_RT_GUARD=$PWD/$1.json LD_PRELOAD=$guard gaitd --scenario "$2" --trust --clock lockstep \
    --socket "$1.sock" --log "$1.mcap" >"$1.txt" 2>&1 || { cat "$1.txt"; fail "$1 does not run"; }
}

# The walk of the scenario swaps, with a push, commands, and clients that ask and command. The swaps come
# one by one, 0.36 s apart, so those of a layer are 2.1 steps apart: they fall all over a step.
sed '/^expect:/,$d; /swap:/d' "$GAITD_SOURCE/sim/scenarios/swaps.yaml" >walk.yaml
awk 'BEGIN {
  split("toe_off whole_body_controller icp_planner step_adjuster state_estimator", layer, " ")
  split("never com_height_qp single_cmp fixed_steps invariant_ekf", variant, " ")
  split("icp_criteria nullspace_qp heel_to_toe step_plan kinematic_inertial", before, " ")
  for (i = 0; i < 140; ++i) {
    k = i % 5 + 1
    printf "  - {at: %.3f, swap: {layer: %s, to: %s}}\n", 2 + 0.36 * i, layer[k], int(i / 5) % 2 ? before[k] : variant[k]
  }
}' >>walk.yaml
cat >>walk.yaml <<'SCENARIO'
  - {at: 6.0, param: {gait.swing_height: 0.12}}
  - {at: 53.0, mode: walk-bent}
  - {at: 55.0, mode: walk-straight}
disturbances:
  - {link: utorso, force: [0, 60, 0], duration: 0.1, when: {time: 10.0}}
SCENARIO
touch asking
for height in 0.115 0.12 0.125; do
  while [[ -e asking ]]; do
    gaitctl --socket walk.sock status >/dev/null 2>&1 || true
    gaitctl --socket walk.sock param set gait.swing_height "$height" >/dev/null 2>&1 || true
    sleep 0.3
  done &
done
guarded walk walk.yaml
rm asking
wait
clean walk 55000

# It is replayed to the bit, and at no swap is a torque further from what the layer before would have
# commanded in that tick than 5 % of the limit of its joint.
expect 0 gaitctl log replay walk.mcap
"$GAITD_BUILD/tests/swap_steps" walk.mcap >steps.txt
awk '{ ++count[$2, $3]; ++all; if ($5 > worst) { worst = $5; line = $0 } }
     END {
       print all + 0, "swaps; the largest torque step, over the limit of the joint:", line
       split("state_estimator icp_planner step_adjuster toe_off whole_body_controller", layer, " ")
       # A swap of toe-off waits until no foot rolls over its toe, which leaves few to the transfers.
       for (i in layer) if (count[layer[i], "swing"] < 5 || count[layer[i], "transfer"] < (layer[i] == "toe_off" ? 2 : 5)) {
         print layer[i] ": too few in swings or transfers"; few = 1
       }
       exit worst > 0.05 || all != 140 || few
     }' steps.txt || { cat steps.txt; fail "see above"; }

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
