# Each row of the table in docs/safety.md that a robot can show, with the motors on: what goes wrong
# and the fault it ends in. conditions.txt and the reports tell the rest.

# condition FAULT CYCLES ARGUMENTS OF THE FAKE ROBOT...
conditions=0
patience=10    # s of wall time that either side waits for frames that do not come
stall_time=600 # s of wall time: a motor that hears nothing outlasts its condition on any machine
condition() {
  local fault=$1 cycles=$2 off=30
  shift 2
  # A motor that hears nothing waits for its own TIMEOUT, which is long here.
  [[ $* == *silent* ]] && off=29
  can_links 5 72
  start_robot "condition$((++conditions))" "$@"
  start_gaitd --set safety.ready_duration=60 --set log.enabled=true --log "$scratch/$fault.mcap"
  wait_healthy
  arm_robot &
  wait_state fault 300
  # An interface comes up again: its motors are switched off first, and stay off.
  [[ $* != *:*_leg=0.5* ]] || wait_status 300 '*"healthy":true*"state":"fault"*'
  pause 0.3
  ask_status
  [[ $status == *"\"faults\":[\"$fault\"]"* ]] || fail "$*: expected only the fault $fault: $status"
  refused "arm:"
  stop_gaitd
  stop_robot
  echo "condition$conditions $fault $cycles $off ${*: -1}" >>"$scratch/conditions.txt"
  echo "${*: -1}: $fault"
}

condition motor 1 --fault error:l_leg_kny=12@0.2 # rotor too hot
condition motor 8 --fault off:r_leg_aky@0.2
condition sensors 22 --fault silent:l_leg_kny@0.2
condition sensors 22 --fault foot:left@0.2
condition sensors 22 --fault imu:pelvis_imu@0.2
condition sensors 22 --fault imu-stuck:pelvis_imu@0.2
condition sensors 22 --fault short:right@0.2
condition estop 22 --fault estop@0.2
condition heartbeat 122 --fault heartbeat@0.2
condition heartbeat 122 --fault estop-stuck@0.2
condition bus 2 --fault down:left_leg=0.5@0.2
condition bus 2 --fault bus-off:right_leg=0.5@0.2
