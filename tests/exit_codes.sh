# gaitctl: 0 done, 1 refused or failed, 2 usage, 3 no daemon.
source "$(dirname "$0")/common.sh"

expect 0 gaitctl --help >/dev/null
expect 0 gaitctl --version
expect 2 gaitctl
expect 2 gaitctl no-such-command
expect 2 gaitctl walk
expect 2 gaitctl walk --steps none
expect 3 gaitctl --socket "$scratch/none.sock" status
expect 3 gaitctl status
expect 1 gaitctl run no-such-scenario
expect 1 gaitctl log info "$scratch/none.mcap"
printf 'not a log' >"$scratch/bad.mcap"
expect 1 gaitctl log info "$scratch/bad.mcap"
expect 1 gaitctl run stand --set duration=0.5 --set no.such.key=1 --log "$scratch/bad-key.mcap"

expect 2 gaitd --clock sundial
expect 1 gaitd --robot no-such-robot
expect 0 gaitd --check-config

start_daemon --clock realtime --log "$scratch/log.mcap"
wait_for state standing 20
expect 0 gaitctl status
expect 0 gaitctl --json status >/dev/null
expect 0 gaitctl plugin list
expect 1 gaitctl walk --steps 1 --length 1.9
expect 1 gaitctl sim push --link no_such_link --force 1,0,0 --duration 0.1
expect 2 gaitctl sim push --link utorso --force 1,0 --duration 0.1
expect 0 gaitctl sim push --link utorso --force 5,0,0 --duration 0.1
expect 0 gaitctl estop
expect 1 gaitctl walk --steps 1
[[ $(field state) == fault ]] || fail "state is '$(field state)' after estop"
expect 0 gaitctl reset
stop_daemon
expect 3 gaitctl status
