# One sensor after the other fails while the robot walks: the fault that docs/balance.md names is
# raised in time, or the robot walks on when the fault is over in time or in a joint that it can do
# without.
source "$(dirname "$0")/common.sh"

# walk SENSOR KIND FROM DURATION [SECONDS]: plays a walk with that fault; its events go to $scratch/events.
walk() {
  cat >"$scratch/walk.yaml" <<SCENARIO
schema: gaitd.scenario/1
name: sensor-fault
robot: atlas
duration: ${5:-9.5}
mode: walk-straight
sensors: {noise: nominal, faults: [{sensor: $1, kind: $2, from: $3, duration: $4}]}
actuators: {model: nominal}
terrain: {friction: 0.8, ground_z: 0}
commands:
  - {at: 2, walk: {steps: 5, length: 0.35, swing: 0.6, transfer: 0.25}}
expect: {no_fall: true}
SCENARIO
  gaitctl run "$scratch/walk.yaml" --log "$scratch/walk.mcap" >"$scratch/verdict" 2>&1 || true
  gaitctl log info "$scratch/walk.mcap" | grep ' fault  *{' >"$scratch/events" || true
}
# faults WITHIN_MS WHAT SENSOR KIND FROM
faults() {
  walk "$3" "$4" "$5" 10 "$(awk "BEGIN { print $5 + 1.2 }")"
  grep -q "\"sensors\".*\"sensor\":\"[a-z_ ]*\",\"what\":\"$2" "$scratch/events" ||
    fail "$3 $4: expected the fault 'sensors', '$2', got: $(cat "$scratch/events")"
  awk -v from="$5" -v within="$1" '{ late = 1000 * ($1 - from); exit !(late > 0 && late <= within) }' \
    "$scratch/events" || fail "$3 $4: not within $1 ms: $(cat "$scratch/events")"
  printf '%-12s %-8s %s\n' "$3" "$4" "$(sed 's/.*"sensor"/"sensor"/' "$scratch/events")"
}
# passes SENSOR KIND FROM DURATION: nothing comes of it.
passes() {
  walk "$@"
  [[ ! -s $scratch/events ]] || fail "$1 $2 for $4 s: $(cat "$scratch/events")"
  grep -q 'ok  *no_fall' "$scratch/verdict" || fail "$1 $2 for $4 s: it fell"
  printf '%-12s %-8s for %s s: it walks on\n' "$1" "$2" "$4"
}

# dropped JOINT KIND WHAT: the robot walks on with the drive of that joint damped, and says so.
dropped() {
  passes "$1" "$2" 4.3 10
  gaitctl log info "$scratch/walk.mcap" >"$scratch/info"
  grep -q "\"dropped\":\"$1\",\"what\":\"$3" "$scratch/info" ||
    fail "$1 $2: nothing in the log: $(cat "$scratch/info")"
}

faults 25 frozen imu freeze 4.3
faults 25 'not credible' imu nan 4.3
faults 25 silent imu silent 4.3
faults 25 'not credible' left_foot spike 4.3
faults 25 silent right_foot silent 4.3
faults 25 'not credible' r_leg_hpy nan 4.3
faults 25 silent back_bky silent 4.3
# A foot in the air may show nothing; it is found out when it carries.
for from in 3.9 4.3 4.7; do faults 800 frozen left_foot dead "$from"; done
for from in 3.9 4.3 4.7; do faults 800 frozen right_foot freeze "$from"; done
for joint in l_leg_kny r_leg_hpy l_leg_aky; do faults 200 stuck "$joint" freeze 4.3; done
passes imu spike 4.3 0.003
passes imu nan 4.3 0.01
passes l_leg_kny nan 4.3 0.005
passes right_foot spike 4.3 0.004
# Balance needs neither head nor arms.
dropped neck_ay nan 'not credible'
dropped neck_ay spike 'not credible'
dropped l_arm_elx silent silent
dropped r_arm_shx nan 'not credible'

# A sensor that the robot does not have is named before anything moves.
sed 's/sensor: [a-z_]*/sensor: l_leg_knee/' "$scratch/walk.yaml" >"$scratch/wrong.yaml"
! gaitctl run "$scratch/wrong.yaml" >"$scratch/refused" 2>&1 || fail "an unknown sensor was taken"
grep -q "sensors.faults\[0\].sensor.*l_leg_kny" "$scratch/refused" || fail "$(cat "$scratch/refused")"

# The G1 has a second IMU, which takes over from one that is silent or says always the same.
for kind in silent freeze; do
  expect 0 gaitctl run g1-flat-0.20 --set "sensors.faults=[{sensor: imu, kind: $kind, from: 4, duration: 10}]" \
    --log "$scratch/second.mcap"
  printf '%-12s %-8s the second one takes over\n' imu "$kind"
done
