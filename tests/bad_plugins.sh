# A plugin that goes wrong in a walk ends in the documented fault, with its layer and the reason in
# the log, and never takes gaitd down – but for a crash inside process(), which does.
source "$(dirname "$0")/common.sh"
layers=$GAITD_BUILD/tests/bad_plugins

cat >"$scratch/walk.yaml" <<'SCENARIO'
schema: gaitd.scenario/1
name: bad-plugin
robot: atlas
duration: 1.6
seed: 1
mode: walk-bent
commands:
  - {at: 0.3, walk: {steps: 2, length: 0.2}}
expect: {no_fall: true}
SCENARIO

# play LAYER FAULT: a run with this layer replaced. Leaves its code in $code, its log in $log and
# what gaitctl printed in $scratch/out.
play() {
  log=$scratch/$1-$2.mcap code=0
  gaitctl run "$scratch/walk.yaml" --set "$1.variant=$layers/$1.so" --set "$1.fault=$2" \
    --log "$log" >"$scratch/out" 2>&1 || code=$?
}

# contained NAME LAYER FAULT FAULT_NAME REASON
contained() {
  play "$2" "$3"
  grep -q 'crashed\|ended with exit code' "$scratch/out" && fail "$2: $1 ended gaitd: $(cat "$scratch/out")"
  ((code == 1)) || fail "$2: $1: exit code $code, expected 1 for a failed run"
  gaitctl --json log info "$log" | tr -d ' \n' >"$scratch/info"
  grep -q "\"faults\":\[[^]]*\"$4\"" "$scratch/info" || fail "$2: $1: no fault $4 in $log"
  grep -q "\"layer\":\"$2\"" "$scratch/info" || fail "$2: $1: the log does not name the layer"
  grep -q "\"what\":\"${5// /}" "$scratch/info" || fail "$2: $1: the log does not say '$5'"
  last=$(gaitctl log export "$log" --signals 'safety/state' | tail -n 1)
  [[ $last == fault ]] || fail "$2: $1: the run ends in state $last"
  echo "$2: $1 ends in the fault $4: $5"
}

play toe_off 0
grep -q 'no_fall' "$scratch/out" || fail "the walk without a fault did not run: $(cat "$scratch/out")"
((code == 0)) || fail "the walk without a fault failed: $(cat "$scratch/out")"

contained "a NaN" state_estimator 1 estimator "joint_velocity: is not finite"
contained "a NaN" icp_planner 1 layer "icp: is not finite"
contained "a NaN" step_adjuster 1 layer "linear_momentum_rate: is not finite"
contained "a NaN" toe_off 1 layer "criterion: is not finite"
contained "a NaN" whole_body_controller 1 solver "commands.joints.torque: is not finite"
contained "an error status" icp_planner 2 layer "GAITD_ERROR"
contained "an exception" state_estimator 3 estimator "GAITD_EXCEPTION"
contained "an exception" whole_body_controller 3 solver "GAITD_EXCEPTION"
contained "a wrong size" step_adjuster 4 layer "size: is not that of the struct"

# Too slow: nothing in lockstep, where wall time never acts.
play toe_off 5
((code == 0)) || fail "too slow, in lockstep: exit code $code: $(cat "$scratch/out")"

# A crash inside process() cannot be contained; it is said what happened.
play step_adjuster 6
((code == 1)) || fail "a crash in process(): exit code $code"
grep -q 'gaitd crashed with SIGSEGV' "$scratch/out" || fail "a crash in process() is not named"

# Too slow in real time: overruns, and the safe stop where the configuration asks for one.
cat >"$scratch/slow.yaml" <<CONFIG
schema: gaitd.config/1
robot: atlas
backend: simbody
realtime: {overrun: stop, overrun_run: 0.01}
CONFIG
start_daemon --config "$scratch/slow.yaml" --clock realtime --log "$scratch/slow.mcap" \
  --set "toe_off.variant=$layers/toe_off.so" --set toe_off.fault=5 --set toe_off.fault_time=1.0
wait_until has_fault overrun || fail "too slow in real time: faults are '$(field faults)'"
kill -0 "$daemon" || fail "too slow in real time ended gaitd"
stop_daemon
echo "too slow in real time ends in the fault overrun"
