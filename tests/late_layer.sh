# `gaitctl status` says where the time of the ticks goes and names the layer that was late; policies
# for overruns; what gaitd got of real time.
source "$(dirname "$0")/common.sh"
cd "$scratch"
slow=(--set "toe_off.variant=$GAITD_BUILD/tests/bad_plugins/toe_off.so" --set toe_off.fault=5
  --set toe_off.fault_time=0.5 --set log.enabled=false) # 4 ms in each tick from 0.5 s on
# value POINTER: of the status.
value() { gaitctl --json status | node -e '
  const path = process.argv[1].split("/")
  let value = JSON.parse(require("fs").readFileSync(0))
  for (const key of path) value = value?.[key]
  console.log(typeof value === "object" ? JSON.stringify(value) : value)' "$1"; }
# wait_late NAME: until the status blames it.
wait_late() {
  is_late() { [[ $(value late/what) == "$1" ]]; }
  wait_until is_late "$1" || fail "late is $(value late), expected $1"
}

# In lockstep it is told, and that is all.
start_daemon --clock lockstep "${slow[@]}"
wait_late toe_off
[[ $(value overruns) == 0 ]] || fail "overruns in lockstep: $(value overruns)"
[[ $(field faults) == none ]] || fail "faults in lockstep: $(field faults)"
(($(value layers/3/over_budget) > 0)) || fail "toe_off is not over its budget"
gaitctl status | tee status.txt
for word in median_us p99_us max_us budget_us over_budget 'late .*what toe_off'; do
  grep -qE "$word" status.txt || fail "the status does not say '$word'"
done
stop_daemon

# In real time it makes overruns; the robot goes on with both policies.
for policy in skip catch_up; do
  start_daemon --clock realtime --set "realtime.overrun=$policy" "${slow[@]}"
  overran() { (($(value overruns) > 20)); }
  wait_until overran || fail "$policy: $(value overruns) overruns"
  wait_late toe_off
  [[ $(field faults) == none ]] || fail "$policy: faults: $(field faults)"
  stop_daemon
done
grep -q 'overruns; late in tick' gaitd.txt || fail "gaitd does not tell of the overruns"

# What there is of real time; without all of it --require-rt does not run.
start_daemon --clock realtime --set log.enabled=false --set realtime.lock_memory=false
[[ $(value realtime/degraded) == *'memory is not locked'* ]] ||
  fail "the status does not say what is degraded: $(value realtime)"
grep -q 'real time, degraded: memory is not locked' gaitd.txt || fail "$(cat gaitd.txt)"
grep -q 'real time: built for' gaitd.txt || fail "the build is not told: $(cat gaitd.txt)"
stop_daemon
expect 1 gaitd --clock realtime --set log.enabled=false --set realtime.lock_memory=false \
  --require-rt >required.txt 2>&1
grep -q 'require-rt: not running degraded' required.txt || fail "$(cat required.txt)"
