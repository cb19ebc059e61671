# Layers are exchanged while the robot walks (see rt_path.sh too); bad ones leave it walking on the layer
# that it had, and the caller with the reason.
source "$(dirname "$0")/common.sh"
cd "$scratch"
bad=$GAITD_BUILD/tests/bad_plugins
zoo=$GAITD_BUILD/daemon/conformance/test/zoo
plugins=$GAITD_BUILD/lib/gaitd/plugins

# scenario NAME DURATION REFUSED COMMAND...: a straight-legged walk with commands (YAML) in it.
scenario() {
  cat >"$1.yaml" <<SCENARIO
schema: gaitd.scenario/1
name: $1
robot: atlas
duration: $2
seed: 1
mode: walk-straight
commands:
  - {at: 0.5, walk: {steps: 5, length: 0.35, swing: 0.6, transfer: 0.25}}
$(for command in "${@:4}"; do echo "  - {$command}"; done)
expect: {no_fall: true, refused_commands: $3}
SCENARIO
}
# play NAME: leaves the log NAME.mcap and the verdict in NAME.out.
play() {
  local code=0
  gaitctl run "$1.yaml" --trust --log "$1.mcap" >"$1.out" 2>&1 || code=$?
  ((code == 0)) || { cat "$1.out"; fail "$1: exit code $code"; }
}
events() { gaitctl --json log info "$1.mcap" | tr -d ' \n'; }

# What does not load, or fails beside the layer in use, never comes into use.
scenario refused 3 5 \
  "at: 1.0, swap: {layer: toe_off, to: $zoo/crash_in_create.so}" \
  "at: 1.1, swap: {layer: toe_off, to: $zoo/crash_in_init.so}" \
  "at: 1.2, swap: {layer: toe_off, to: $zoo/no_process.so}" \
  "at: 1.3, swap: {layer: toe_off, to: $GAITD_BUILD/daemon/host/test/plugins/toe_off/bad_version.so}" \
  "at: 1.4, swap: {layer: toe_off, to: no_such_variant}"
play refused
for reason in 'create: has crashed with SIGSEGV' 'init: has crashed with SIGSEGV' \
  'no function in the vtable for: process' 'needs a semantic version' 'no_such_variant'; do
  grep -q "$reason" refused.out || { cat refused.out; fail "no refusal says '$reason'"; }
done
scenario shadow 3 1 "at: 1.4, swap: {layer: toe_off, to: $bad/toe_off.so}"
reasons=('' 'is not finite' 'GAITD_ERROR' 'GAITD_EXCEPTION' 'size: is not that of the struct')
for fault in 1 2 3 4; do # NaN, error, exception, size
  GAITD_TEST_FAULT=$fault GAITD_TEST_FAULT_TIME=0 play shadow
  grep -q "${reasons[fault]}" shadow.out || { cat shadow.out; fail "not '${reasons[fault]}'"; }
done
echo "bad libraries are refused, the robot walks on"

# What fails later is taken back, and the layer before goes on in the same tick.
swaps=() layers=(state_estimator icp_planner step_adjuster toe_off whole_body_controller task_source)
for layer in "${layers[@]}"; do swaps+=("at: 2.0, swap: {layer: $layer, to: $bad/$layer.so}"); done
scenario rolled_back 4 6 "${swaps[@]}"
for fault in 1 3; do # NaN, exception
  GAITD_TEST_FAULT=$fault GAITD_TEST_FAULT_TIME=2.6 play rolled_back
  for layer in "${layers[@]}"; do
    [[ $(events rolled_back) == *"\"layer\":\"$layer\""*'"step":"rolledback"'* ]] ||
      fail "fault $fault: $layer was not taken back"
  done
done
scenario diverging 4 4 "${swaps[@]:1:2}" "${swaps[@]:4:2}"
GAITD_TEST_FAULT=7 GAITD_TEST_FAULT_TIME=1.5 play diverging
grep -q 'too far from that of the layer in use' diverging.out || fail "$(cat diverging.out)"
scenario drifting 4 1 "${swaps[1]}"
GAITD_TEST_FAULT=7 GAITD_TEST_FAULT_TIME=2.5 play drifting
grep -q 'the ICP error grows' drifting.out || fail "$(cat drifting.out)"
echo "layers that fail in use are taken back, the robot walks on"

# By hand, in real time.
export GAITD_TEST_FAULT=5 GAITD_TEST_FAULT_TIME=0 # too slow
start_daemon --clock realtime --log by_hand.mcap
wait_for state standing 60
swap() { expect "$1" gaitctl plugin swap "${@:2}" >swap.out 2>&1; }
expect 0 gaitctl walk --steps 40 --length 0.1
wait_for state walking 20
swap 0 toe_off never
grep -q 'toe_off is never now' swap.out || fail "$(cat swap.out)"
[[ $(gaitctl plugin list | awk '$1 == "*" && $2 == "toe_off" { print $3 }') == never ]] ||
  fail "plugin list does not mark never"
if gaitctl param list toe_off >param.out 2>&1; then fail "parameters of a layer that is gone"; fi
expect 0 gaitctl plugin rollback toe_off
gaitctl param list toe_off | grep -c toe_off. >param.out || fail "its parameters did not come back"
# The same file name, another library in it: the new code runs.
cp "$plugins/toe_off/never.so" mine.so
swap 0 toe_off ./mine.so
cp "$plugins/toe_off/icp_criteria.so" other.so && mv other.so mine.so
swap 0 toe_off ./mine.so
grep -q 'toe_off is icp_criteria now' swap.out || fail "the old code runs: $(cat swap.out)"
gaitctl plugin list >list.out
[[ $(awk '$1 == "*" && $2 == "toe_off" { print $3, $NF }' list.out) == "icp_criteria "*/mine.so ]] ||
  fail "plugin list does not mark mine.so: $(cat list.out)"
swap 1 toe_off "$bad/toe_off.so"
grep -q 'longer than the period' swap.out || fail "$(cat swap.out)"
swap 1 toe_off "$zoo/crash_in_create.so"
expect 1 gaitctl plugin rollback icp_planner
[[ $(field faults) == none ]] || fail "faults: $(field faults)"
stop_daemon
echo "layers are exchanged by hand"
