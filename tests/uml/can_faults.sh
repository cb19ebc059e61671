# What can go wrong with a robot on CAN ends in the documented fault within the documented time, and
# no torque is sent after it. Injected by the fake robot, over real CAN sockets.
source "$(dirname "$0")/uml.sh"
uml_start_or_skip
uml_run can_faults_inside.sh 1500

# What the robot reported is in the logs: they replay to the same faults.
for fault in motor bus estop heartbeat sensors; do
  gaitctl log replay "$scratch/$fault.mcap" >"$scratch/replay.txt" 2>&1 || true
  grep -q identical "$scratch/replay.txt" || fail "$fault: $(cat "$scratch/replay.txt")"
done
echo "the logs replay to the same bits"
