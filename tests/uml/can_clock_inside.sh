# In real time, which means little in here: long periods, and long patience with sensors and e-stop.
can_links 3 16
sed 's/heartbeat: .*}/heartbeat: 10}/' "$GAITD_SOURCE/robots/atlas/can-classic.yaml" >"$scratch/can.yaml"
# So far above the ground that nothing weighs anything.
start_robot clock --can "$scratch/can.yaml" --period 0.01 \
  --world '{"terrain": {"ground_z": 0.0}, "start": {"z": 100000.0}}'
batch gaitd --backend socketcan --clock realtime --set log.enabled=false \
  --set can="$scratch/can.yaml" --set period=0.01 \
  --set safety.ready_duration=60 --set safety.sensor_timeout=1 >"$scratch/gaitd.txt" 2>&1 &
gaitd=$!
wait_healthy

# step_clock MICROSECONDS: sets the clock forward or back while the robot is armed. A machine that
# stands still for a second makes sensors stale, too: then it is tried again.
step_clock() {
  local attempt us
  for attempt in 1 2 3; do
    ask_status
    [[ $status != *'"state":"fault"'* ]] || gaitctl reset >/dev/null
    [[ $status == *'"state":"readying"'* ]] || gaitctl --json arm >/dev/null 2>&1 &
    wait_status 120 '*"state":"readying"*'
    us=$((${EPOCHREALTIME/./} + $1))
    date -s "@$((us / 1000000)).$(printf %06d $((us % 1000000)))" >/dev/null
    pause 0.5
    ask_status
    if [[ $status == *'"faults":[]'*'"state":"readying"'* ]]; then
      echo "$(($1 / 1000)) ms: no fault"
      return
    fi
    echo "$(($1 / 1000)) ms, attempt $attempt: $status"
  done
  fail "a step of the wall clock by $(($1 / 1000)) ms is a fault"
}

step_clock 3600000000
step_clock -3600000000
step_clock 500000
step_clock -500000
stop_gaitd
stop_robot
