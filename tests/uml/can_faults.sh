# What can go wrong with a robot on CAN ends in the documented fault within the documented time, and
# no torque is sent after it. Injected by the fake robot, over real CAN sockets.
source "$(dirname "$0")/uml.sh"
uml_start_or_skip
uml_run can_faults_inside.sh 1500
