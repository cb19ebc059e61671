# Atlas stands and walks over CAN sockets in lockstep with the fake robot: five FD buses at 1 kHz,
# three classic ones at 250 Hz.
source "$(dirname "$0")/uml.sh"
uml_start_or_skip
uml_run can_walk_inside.sh 1500
