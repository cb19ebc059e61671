# What can go wrong with a robot on CAN ends in the documented fault within the documented time, and
# no torque is sent after it. Injected by the fake robot, over real CAN sockets.
source "$(dirname "$0")/uml.sh"
uml_start_or_skip
uml_run can_faults_inside.sh 2700

# Within how many cycles the last torque is sent, and that none follows until an operator resets and
# arms.
while read -r name fault cycles off what; do
  expect_report "$name" "0 < r['first_torque_cycle'] < r['fault_cycle']" \
    "r['last_torque_cycle'] <= r['fault_cycle'] + $cycles" \
    "r['cycles'] > r['fault_cycle'] + $cycles + 10" "r['motors']['off'] == $off" \
    "print('$what: $fault, last torque', r['last_torque_cycle'] - r['fault_cycle'], 'cycles later, allowed $cycles') or True"
done <"$scratch/conditions.txt"

# What the robot reported is in the logs: they replay to the same faults.
for fault in motor bus estop heartbeat sensors; do
  gaitctl log replay "$scratch/$fault.mcap" >"$scratch/replay.txt" 2>&1 || true
  grep -q identical "$scratch/replay.txt" || fail "$fault: $(cat "$scratch/replay.txt")"
done
echo "the logs replay to the same bits"
