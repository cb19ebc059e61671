# Bring-up over real CAN sockets: starts that are refused, one joint on the hoist, lost and doubled
# frames, e-stop and the way back, and motors that switch off by themselves when gaitd dies.
source "$(dirname "$0")/uml.sh"
uml_start_or_skip
uml_run can_bringup_inside.sh 1500

expect_report joint_test "r['motors']['off'] == 30 and r['first_torque_cycle'] > 0" \
  "r['cycles'] > r['last_torque_cycle'] + 1"
expect_report killed "sum('communication lost' in e for e in r['events']) == 30" \
  "r['motors']['off'] == 30"
echo "killed: the motors switched off by themselves"
