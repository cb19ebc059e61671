# Who sets the wall clock does not hurt a robot with torque on its motors: no sensor is stale, no
# fault. In real time, and inside User-Mode Linux, whose clock is its own.
source "$(dirname "$0")/uml.sh"
uml_start_or_skip
uml_run can_clock_inside.sh 600
expect_report clock "r['first_torque_cycle'] > 0" "r['motors']['off'] == 30"
