# step_clock MICROSECONDS...: sets the wall clock forward and back, one step after the other.
step_clock() {
  local step us
  for step in "$@"; do
    us=$((${EPOCHREALTIME/./} + step))
    date -s "@$((us / 1000000)).$(printf %06d $((us % 1000000)))" >/dev/null
    pause 0.5
  done
}

# walk BUSES MTU ARGUMENTS...: stands and walks six steps over real CAN sockets.
walk() {
  local buses=$1 mtu=$2 start=$SECONDS
  shift 2
  can_links "$buses" "$mtu"
  local robot_options=() gaitd_options=()
  if [[ $# -gt 0 ]]; then
    robot_options=(--can "$1" --period "$2")
    gaitd_options=(--set "can=$1" --set "period=$2")
  fi
  start_robot "walk$buses" "${robot_options[@]}"
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
walk 3 16 can-classic.yaml 0.004
