# In real time, which means little in here: a long period, and patience with sensors and e-stop. Who
# reads every second sample of the fake robot, late as they are, sees a sensor that is frozen. It does a
# millisecond in each cycle, and high above the ground it weighs nothing.
can_links 5 72
sed 's/heartbeat: .*}/heartbeat: 10}/' "$GAITD_SOURCE/robots/atlas/can-fd.yaml" >"$scratch/can.yaml"
start_robot clock --can "$scratch/can.yaml" \
  --world '{"terrain": {"ground_z": 0.0}, "start": {"z": 10000.0}}'
# Nobody has a real-time priority: on this one processor it would leave nothing to the others.
setpriv --bounding-set=-sys_nice chrt --batch 0 gaitd --backend socketcan --clock realtime --set log.enabled=false \
  --set can="$scratch/can.yaml" --set period=0.02 \
  --set safety.ready_duration=60 --set safety.sensor_timeout=1 --set safety.frozen_time=0 >"$scratch/gaitd.txt" 2>&1 &
gaitd=$!

ready() {
  wait_healthy
  gaitctl --json arm >/dev/null 2>&1 &
  wait_state readying 60
}

# step_clock MICROSECONDS: sets the clock forward or back while the robot is armed. A machine that
# stands still for a second makes sensors stale, too: then it is tried again.
step_clock() {
  local attempt us
  for attempt in 1 2 3; do
    us=$((${EPOCHREALTIME/./} + $1))
    date -s "@$((us / 1000000)).$(printf %06d $((us % 1000000)))" >/dev/null
    pause 0.5
    ask_status
    if [[ $status == *'"faults":[]'*'"state":"readying"'* ]]; then
      echo "a step of the wall clock by $(($1 / 1000)) ms: no fault"
      return
    fi
    echo "attempt $attempt, a step of $(($1 / 1000)) ms: $status"
    gaitctl reset >/dev/null
    ready
  done
  fail "a step of the wall clock is a fault"
}

ready
step_clock 3600000000
step_clock -3600000000
step_clock 500000
step_clock -500000
stop_gaitd
stop_robot
