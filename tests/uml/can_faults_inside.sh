# Each row of the table in docs/safety.md that a robot can show, with the motors on: what goes wrong,
# the fault it ends in, within how many cycles the last torque is sent, and that none follows
# until an operator resets and arms.
can_links 5 72

# condition FAULT CYCLES ARGUMENTS OF THE FAKE ROBOT...
condition() {
  local fault=$1 cycles=$2
  shift 2
  can_links 5 72
  start_robot "$@"
  start_gaitd --set safety.ready_duration=60 --set log.enabled=true --log "$scratch/$fault.mcap"
  gaitctl --json arm >/dev/null 2>&1 &
  wait_state fault 300
  # An interface comes up again: its motors are switched off first, and stay off.
  until [[ $* != *:*_leg=0.5* || $(field health) == *"healthy yes"* ]]; do sleep 0.2; done
  sleep 0.3
  [[ $(field faults) == "$fault" ]] || fail "$*: faults '$(field faults)', expected $fault"
  refused "arm:"
  stop_gaitd
  stop_robot
  # A motor that hears nothing waits for its own TIMEOUT, which is long here.
  local off=30
  [[ $* == *silent* ]] && off=29
  expect_json robot.json "0 < r['first_torque_cycle'] < r['fault_cycle']" \
    "r['last_torque_cycle'] <= r['fault_cycle'] + $cycles" \
    "r['cycles'] > r['fault_cycle'] + $cycles + 10" "r['motors']['off'] == $off" \
    "print('last torque', r['last_torque_cycle'] - r['fault_cycle'], 'cycles later') or True"
  echo "${*: -1}: $fault, allowed $cycles"
}

# refused TEXT: arming is refused, for this reason.
refused() {
  local answer
  answer=$(gaitctl arm 2>&1) && fail "armed, expected a refusal because of $1"
  [[ $answer == *"$1"* ]] || fail "refused with '$answer', expected $1"
}

# start_refused TEXT ARGUMENTS OF THE FAKE ROBOT...: gaitd does not start and says why.
start_refused() {
  local text=$1
  shift
  start_robot "$@"
  if timeout 300 gaitd --backend socketcan --clock lockstep --set log.enabled=false >gaitd.txt 2>&1; then
    fail "gaitd starts with $*"
  fi
  grep -q -- "$text" gaitd.txt || fail "$*: gaitd does not say '$text'"
  stop_robot
  echo "${*: -1}: start refused, $text"
}

condition motor 1 --fault error:l_leg_kny=12@0.2 # rotor too hot
condition motor 8 --fault off:r_leg_aky@0.2
condition sensors 22 --fault silent:l_leg_kny@0.2
condition sensors 22 --fault foot:left@0.2
condition sensors 22 --fault imu:pelvis_imu@0.2
condition estop 22 --fault estop@0.2
condition heartbeat 122 --fault heartbeat@0.2
condition bus 2 --fault down:left_leg=0.5@0.2
condition bus 2 --fault bus-off:right_leg=0.5@0.2

start_refused "expected PMAX 26 as robot.yaml says, the motor has 12.5" --fault range:l_leg_kny=12.5
start_refused "TIMEOUT is 0" --fault timeout:back_bkz=0
start_refused "no answer; check power" --fault silent:neck_ay

# One joint moves, on the hoist; the others stay off. Far above the ground nothing weighs anything, and
# who is let go does not fall over.
hoist=(--world '{"terrain": {"ground_z": 0.0}, "start": {"z": 900.0}}')
start_robot "${hoist[@]}"
start_gaitd
gaitctl joint list | grep -q '^l_leg_kny ' || fail "no l_leg_kny in 'gaitctl joint list'"
gaitctl joint test l_leg_kny --amplitude 0.05 --duration 0.5 || fail "the joint test"
[[ $(field state) == disarmed ]] || fail "after the joint test: $(field state)"
stop_gaitd
stop_robot
expect_json robot.json "r['motors']['off'] == 30 and r['first_torque_cycle'] > 0" \
  "r['cycles'] > r['last_torque_cycle'] + 1"

# Lost and doubled frames: counted, and no fault.
stall_time=6
start_robot "${hoist[@]}" --fault lose:l_leg_kny=7 --fault duplicate:r_leg_kny
start_gaitd --set safety.ready_duration=60
gaitctl --json arm >/dev/null 2>&1 &
wait_state readying 120
sleep 2
health=$(field health)
[[ $health == *"duplicate "[1-9]*"healthy yes"*"missing "[1-9]* ]] || fail "health '$health'"
echo "lost and doubled frames: $health"

# The e-stop of the CLI, then the way back: reset, arm.
gaitctl estop >/dev/null
wait_state fault 60
refused "arm:"
gaitctl reset >/dev/null
[[ $(field state) == disarmed ]] || fail "after reset: $(field state)"
gaitctl --json arm >/dev/null 2>&1 &
wait_state readying 120

# gaitd dies with torque on the motors: they switch off by themselves, after their TIMEOUT.
kill -KILL "$gaitd"
wait "$gaitd" 2>/dev/null || true
sleep "$((stall_time + 1))"
stop_robot
expect_json robot.json "sum('communication lost' in e for e in r['events']) == 30 and r['motors']['off'] == 30"
echo "estop, reset, arm: in order; killed: the motors switched off by themselves"
