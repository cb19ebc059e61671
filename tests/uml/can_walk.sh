# Atlas stands and walks over CAN sockets in lockstep with the fake robot: on FD buses at 1 kHz, and on
# classic ones at 250 Hz with two families of motors. Then it is armed in real time, on the hoist,
# while the wall clock is set.
source "$(dirname "$0")/uml.sh"
uml_start_or_skip
uml_run can_walk_inside.sh 1500
for walk in walk72 walk16; do
  expect_report "$walk" "r['pelvis'][0] > 1.35 and abs(r['pelvis'][1]) < 0.1" \
    "r['lowest_pelvis'] > 0.75" "r['motors'] == {'with_torque': 0, 'damped': 0, 'off': 30}"
done
expect_report hang "r['first_torque_cycle'] > 0 and r['motors']['off'] == 30"
