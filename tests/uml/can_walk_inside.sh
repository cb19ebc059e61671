# step_clock MICROSECONDS...: sets the wall clock forward and back, one step after the other.
step_clock() {
  local step us
  for step in "$@"; do
    us=$((${EPOCHREALTIME/./} + step))
    date -s "@$((us / 1000000)).$(printf %06d $((us % 1000000)))" >/dev/null
    pause 0.5
  done
}

# walk BUSES MTU [WIRING PERIOD]: stands and walks six steps over real CAN sockets.
walk() {
  local buses=$1 mtu=$2 start=$SECONDS
  shift 2
  can_links "$buses" "$mtu"
  local robot_options=() gaitd_options=()
  if [[ $# -gt 0 ]]; then
    robot_options=(--can "$1" --period "$2")
    gaitd_options=(--set "can=$1" --set "period=$2")
  fi
  start_robot "walk$mtu" "${robot_options[@]}"
  start_gaitd "${gaitd_options[@]}"
  [[ $status == *'"state":"disarmed"'* ]] || fail "a robot comes up disarmed: $status"
  wait_healthy
  arm_robot || fail "not armed"
  wait_state standing 600
  gaitctl mode walk-straight >/dev/null
  gaitctl walk --steps 6 --length 0.25 --swing 0.6 --transfer 0.25 >/dev/null
  wait_state walking 600
  step_clock 3600000000 -3600000000 500000 -500000 # nobody may notice
  wait_state standing 1200
  [[ $status == *'"faults":[]'* ]] || fail "faults: $status"
  [[ $status =~ \"health\":[^}]*\} ]] && echo "${BASH_REMATCH[0]}"
  stop_gaitd
  stop_robot
  grep -E 'load at' gaitd.txt
  echo "walked six steps over $buses buses in $((SECONDS - start)) s"
}

walk 5 72

# On classic buses with motors of two families: RobStride with 29 bits of identifier, and Damiao in the
# right arm and in the neck.
sed 's/, data_bitrate: 5e6//; s/dialect: damiao/dialect: robstride/
  /bus: right_arm\|neck/s/bus: [a-z_]*,/& dialect: damiao,/
  /dialect: damiao/!s/, reply_id: 0x[0-9A-F]*//' \
  "$GAITD_SOURCE/robots/atlas/can-fd.yaml" >"$scratch/mixed.yaml"
walk 5 16 "$scratch/mixed.yaml" 0.004

# hang: in real time, where the age of a sensor comes from the wall clock's stamp of its frame. No step
# of that clock makes one stale, or hides a silent one. Armed on the hoist, on the way to the standing
# posture: every sensor is looked at then, and nobody falls over because this machine is late.
hang() {
  local start=$SECONDS wiring=$scratch/patient.yaml
  sed 's/heartbeat: 0.1/heartbeat: 10/' "$GAITD_SOURCE/robots/atlas/can-classic.yaml" >"$wiring"
  can_links 3 16
  robot_runs=at_once start_robot hang --can "$wiring" --period 0.004 \
    --world '{"terrain": {"ground_z": 0.0}, "start": {"z": 10000.0}, "time_step": 0.002}'
  clock=realtime start_gaitd --set can="$wiring" --set period=0.02 --set safety.sensor_timeout=1 \
    --set safety.ready_duration=60
  wait_healthy
  arm_robot || fail "not armed"
  wait_state readying 60
  step_clock -3600000000 3600000000
  ask_status
  [[ $status == *'"faults":[]'*'"state":"readying"'* ]] || fail "after steps of the clock: $status"
  [[ $status =~ \"health\":[^}]*\} ]] && echo "${BASH_REMATCH[0]}"
  step_clock 3600000000
  kill -STOP "$robot"
  wait_state fault 30
  [[ $status == *'"faults":["sensors"]'* ]] || fail "of a silent robot: $status"
  kill -CONT "$robot"
  step_clock -3600000000
  stop_gaitd
  stop_robot
  echo "hung in real time, $((SECONDS - start)) s"
}

hang
