# One long stall of the whole daemon is the fault `overrun` where overruns are one: not the number of
# ticks that were late counts, but how long the robot was left alone.
source "$(dirname "$0")/common.sh"

start_daemon --clock realtime --set realtime.overrun=stop --set realtime.overrun_run=0.4
wait_for state standing 60
kill -STOP "$daemon"
sleep 0.8
kill -CONT "$daemon"
for _ in {1..100}; do
  [[ $(field state) == fault ]] && break
  sleep 0.1
done
[[ $(field faults) == overrun ]] || fail "faults: $(field faults), expected overrun"
stop_daemon
