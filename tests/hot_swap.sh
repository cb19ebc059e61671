# Layers are exchanged while the robot walks: by scenarios and by hand; bad ones leave it walking on
# the layer that it had, and the caller with the reason.
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
  gaitctl run "$1.yaml" --log "$1.mcap" >"$1.out" 2>&1 || code=$?
  ((code == 0)) || { cat "$1.out"; fail "$1: exit code $code"; }
}
events() { gaitctl --json log info "$1.mcap" | tr -d ' \n'; }

# At the tick of a swap no torque is further from what the layer before would have commanded than 5 %
# of the limit of its joint: the same walk without the swap is the same up to there, bit by bit.
awk 'match($0, /<joint name="[^"]*"/) { name = substr($0, RSTART + 13, RLENGTH - 14) }
     match($0, /effort="[^"]*"/) { print name, substr($0, RSTART + 8, RLENGTH - 9) }' \
  "$GAITD_SOURCE/robots/atlas/atlas.urdf" >limits
torques() {
  gaitctl log export "$1.mcap" --signals 'tick,joint/*/torque_desired' -o "$1.csv"
}
# torque_step NAME TICK BOUND: over the limit of the joint, the worst.
torque_step() {
  awk -F, -v tick="$2" -v bound="$3" '
    FILENAME == "limits" { split($0, word, " "); limit[word[1]] = word[2]; next }
    FNR == 1 { for (i = 1; i <= NF; ++i) { split($i, part, "/"); joint[i] = part[2] } next }
    FILENAME == "alone.csv" { alone[$1] = $0; next }
    $1 < tick && $0 != alone[$1] { print "differs before the swap, in tick " $1; exit 1 }
    $1 == tick {
      split(alone[$1], before, ",")
      for (i = 2; i <= NF; ++i) {
        step = ($i - before[i]) / limit[joint[i]]; if (step < 0) step = -step
        if (step > worst) { worst = step; name = joint[i] }
      }
      print "torque step", worst + 0, "of the limit", name; found = 1
      exit worst > bound
    }
    END { if (!found) exit 1 }' limits alone.csv "$1.csv"
}
scenario alone 2.6 0
play alone
torques alone
# 1.85 s is in a transfer, 2.3 s in a swing; the switch comes 0.2 s after the command.
for at in 1.65 2.1; do
  tick=$(awk -v at="$at" 'BEGIN { printf "%d", 1000 * at + 200.5 }')
  for swap in whole_body_controller/com_height_qp icp_planner/single_cmp toe_off/never \
    state_estimator/invariant_ekf step_adjuster/fixed_steps; do
    name=${swap%%/*}-$tick
    [[ $name == toe_off-2300 ]] && continue # it waits: toe-off is active there
    scenario "$name" 2.6 0 "at: $at, swap: {layer: ${swap%%/*}, to: ${swap#*/}}"
    play "$name"
    torques "$name"
    printf '%s: ' "$name"
    torque_step "$name" "$tick" 0.05 || fail "$name: see above"
    [[ $(events "$name") == *'"step":"switched","tick":'$tick* ]] || fail "$name: no swap at $tick"
  done
done

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
swaps=() layers=(state_estimator icp_planner step_adjuster toe_off whole_body_controller)
for layer in "${layers[@]}"; do swaps+=("at: 2.0, swap: {layer: $layer, to: $bad/$layer.so}"); done
scenario rolled_back 4 5 "${swaps[@]}"
for fault in 1 3; do # NaN, exception
  GAITD_TEST_FAULT=$fault GAITD_TEST_FAULT_TIME=2.6 play rolled_back
  for layer in "${layers[@]}"; do
    [[ $(events rolled_back) == *"\"layer\":\"$layer\""*'"step":"rolledback"'* ]] ||
      fail "fault $fault: $layer was not taken back"
  done
done
scenario diverging 4 3 "${swaps[@]:1:2}" "${swaps[4]}"
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
swap 1 toe_off "$bad/toe_off.so"
grep -q 'longer than the period' swap.out || fail "$(cat swap.out)"
swap 1 toe_off "$zoo/crash_in_create.so"
expect 1 gaitctl plugin rollback icp_planner
[[ $(field faults) == none ]] || fail "faults: $(field faults)"
stop_daemon
echo "layers are exchanged by hand"
