# One long stall of the whole daemon is the fault `overrun` where overruns are one: not the number of
# ticks that were late counts, but how long the robot was left alone.
source "$(dirname "$0")/common.sh"

start_daemon --clock realtime --set realtime.overrun=stop --set realtime.overrun_run=0.4
wait_for state standing 60
kill -STOP "$daemon"
sleep 0.8
kill -CONT "$daemon"
wait_until has_fault overrun || true
[[ $(field faults) == overrun ]] || fail "faults: $(field faults), expected overrun"
stop_daemon
