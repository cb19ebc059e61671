# A push that no step can catch: the fault 'capture' says so well before the pelvis is low, with the
# figures, and the joints are damped from then on.
source "$(dirname "$0")/common.sh"

# fall NAME ARGUMENTS: the event of the fault to $scratch/NAME.event, its time to $time.
fall() {
  local name=$1
  shift
  gaitctl run push-bent-sideways --set 'disturbances.0.force=[0, 1500, 0]' --log "$scratch/$name.mcap" \
    "$@" >"$scratch/$name.verdict" 2>&1 && fail "the robot recovers: $(cat "$scratch/$name.verdict")"
  gaitctl log info "$scratch/$name.mcap" | grep ' fault  *{' | head -1 >"$scratch/$name.event"
  time=$(awk '{ print $1 }' "$scratch/$name.event")
}

fall early
early=$time
what='"faults":\["fall","capture"\].*"what":"ICP [0-9.]* m off the feet, beyond [0-9.]* m"'
grep -q "$what" "$scratch/early.event" || fail "$(cat "$scratch/early.event")"
fall late --set safety.capture_reach=10
grep -q '"faults":\["fall"' "$scratch/late.event" || fail "$(cat "$scratch/late.event")"
! grep -q capture "$scratch/late.event" || fail "$(cat "$scratch/late.event")"
awk -v early="$early" -v late="$time" 'BEGIN {
  printf "recognised %.3f s before the pelvis is low\n", late - early
  exit !(late - early > 0.1) }' || fail "at $early s and $time s"
# Damped: no torque is asked for from the fault on.
torque=$(gaitctl log export "$scratch/early.mcap" --signals 'time,joint/*_leg_*/torque_desired' |
  awk -F, -v from="$early" 'NR > 1 && $1 > from + 0.002 { for (i = 2; i <= NF; ++i) { t = $i < 0 ? -$i : $i; if (t > most) most = t } } END { print most + 0 }')
awk -v torque="$torque" 'BEGIN { exit torque > 0 }' || fail "$torque N m after the fault"
