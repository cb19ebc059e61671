# What is refused at the start; then what an operator does with a robot, and the death of gaitd.
can_links 5 72

# start_refused TEXT ARGUMENTS OF THE FAKE ROBOT...: gaitd does not start and says why.
start_refused() {
  local text=$1
  shift
  start_robot refused "$@"
  if timeout 300 gaitd --backend socketcan --clock lockstep --set log.enabled=false >gaitd.txt 2>&1; then
    fail "gaitd starts with $*"
  fi
  [[ $(<gaitd.txt) == *"$text"* ]] || fail "$*: gaitd does not say '$text'"
  stop_robot
  echo "${*: -1}: start refused, $text"
}

start_refused "expected PMAX 26 as robot.yaml says, the motor has 12.5" --fault range:l_leg_kny=12.5
start_refused "expected PMAX 26 as robot.yaml says, the motor has nan" --fault nan-range:l_leg_kny
start_refused "TIMEOUT is 0" --fault timeout:back_bkz=0
start_refused "no answer; check power" --fault silent:neck_ay

# not_armed TEXT FAULT OF THE FAKE ROBOT: nothing is switched on, and the status says why.
not_armed() {
  start_robot not_armed --fault "$2"
  start_gaitd
  wait_status 60 "*$1*"
  refused "not armed: the e-stop is silent"
  stop_gaitd
  stop_robot
  echo "$2: not armed, $1"
}

not_armed "the e-stop was never heard" heartbeat
not_armed "the e-stop repeats itself" estop-stuck

# One joint moves, on the hoist; the others stay off. Far above the ground nothing weighs anything, and
# who is let go does not fall over.
hoist=(--world '{"terrain": {"ground_z": 0.0}, "start": {"z": 900.0}}')
start_robot joint_test "${hoist[@]}"
start_gaitd
wait_healthy
[[ $(gaitctl joint list) == *$'\n'"l_leg_kny "* ]] || fail "no l_leg_kny in 'gaitctl joint list'"
gaitctl joint test l_leg_kny --amplitude 0.05 --duration 0.5 || fail "the joint test"
ask_status
[[ $status == *'"state":"disarmed"'* ]] || fail "after the joint test: $status"
stop_gaitd
stop_robot

# Lost and doubled frames: counted, and no fault.
stall_time=6
start_robot killed "${hoist[@]}" --fault lose:l_leg_kny=7 --fault duplicate:r_leg_kny
start_gaitd --set safety.ready_duration=60
wait_healthy
arm_robot &
wait_state readying 120
pause 2
wait_status 60 '*"duplicate":[1-9]*"healthy":true*"missing":[1-9]*"state":"readying"*'
echo "lost and doubled frames are counted"

# The e-stop of the CLI, then the way back: reset, arm.
gaitctl estop >/dev/null
wait_state fault 60
refused "arm:"
gaitctl reset >/dev/null
ask_status
[[ $status == *'"state":"disarmed"'* ]] || fail "after reset: $status"
arm_robot &
wait_state readying 120

# gaitd dies with torque on the motors: they switch off by themselves, after their TIMEOUT.
kill -KILL "$gaitd"
wait "$gaitd" 2>/dev/null || true
pause "$((stall_time + 1))"
stop_robot
echo "estop, reset, arm: in order"
