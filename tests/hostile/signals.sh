# What a terminal, a reader of the output and a layer that hangs do to gaitd.
source "$(dirname "$0")/../common.sh"

# Nobody reads what it says: it goes on.
start_daemon --clock lockstep --set log.enabled=false
stop_daemon
mkfifo "$scratch/pipe"
gaitd --clock lockstep --set log.enabled=false >"$scratch/pipe" 2>&1 &
daemon=$!
head -n 1 "$scratch/pipe" >/dev/null # and the reader has gone
for _ in {1..100}; do
  gaitctl status >/dev/null 2>&1 && break
  sleep 0.1
done
gaitctl estop >/dev/null # it says something of this
sleep 0.3
gaitctl status | grep -qx 'state *fault' || fail "gaitd does not go on without a reader"

# The terminal goes: an orderly end, as by SIGTERM.
kill -HUP "$daemon"
code=0
wait "$daemon" || code=$?
daemon=
((code == 0)) || fail "gaitd ended with $code on SIGHUP, expected 0"
echo "no reader, SIGHUP: in order"

# Told to end while it starts, here while a library hangs in its try, it ends at once.
gaitd --clock lockstep --set log.enabled=false \
  --set "toe_off.variant=$GAITD_BUILD/daemon/host/test/plugins/toe_off/hang_at_load.so" \
  >"$scratch/start.txt" 2>&1 &
daemon=$!
sleep 1
began=$SECONDS
kill -TERM "$daemon"
code=0
wait "$daemon" || code=$?
daemon=
((code == 143 && SECONDS - began <= 2)) ||
  fail "gaitd ended with $code after $((SECONDS - began)) s: $(cat "$scratch/start.txt")"
# Nor does it wait for somebody to read its log.
mkfifo "$scratch/log"
expect 1 timeout 30 gaitd --clock lockstep --log "$scratch/log" >"$scratch/start.txt" 2>&1
grep -q 'let somebody read the pipe' "$scratch/start.txt" || fail "$(cat "$scratch/start.txt")"
echo "a start that hangs: ended"

# A layer hangs: the status says that it is stale and where, an e-stop that nobody acts on it. A
# stop that was asked for does not wait for the layer.
start_daemon --clock lockstep --log "$scratch/hangs.mcap" \
  --set "state_estimator.variant=$GAITD_BUILD/tests/bad_plugins/state_estimator.so"
for _ in {1..600}; do
  [[ $(field state) == standing ]] && break
  sleep 0.1
done
gaitctl param set state_estimator.fault 8 >/dev/null 2>&1 & # is never answered
for _ in {1..100}; do
  status=$(gaitctl --json status)
  [[ $status == *'"stale": true'* ]] && break
  sleep 0.1
done
[[ $status == *'"stale": true'* ]] || fail "the status is not stale: $status"
expect 1 gaitctl estop >"$scratch/estop.txt" 2>&1
grep -q 'use the e-stop of the robot' "$scratch/estop.txt" || fail "$(cat "$scratch/estop.txt")"
[[ $status == *'"hangs_in": "state_estimator"'* ]] || fail "the status does not say where: $status"
gaitctl status >"$scratch/status.txt"
grep -q 'STALE: no tick for .* s (hangs in state_estimator)' "$scratch/status.txt" || fail "$(cat "$scratch/status.txt")"
kill -TERM "$daemon"
code=0
wait "$daemon" || code=$?
daemon=
((code == 1)) || fail "a daemon that hangs ends with $code, expected 1"
grep -q 'state_estimator faulty does not return; gaitd ends without it' "$scratch/gaitd.txt" || fail "nothing said of the end"
gaitctl --json log info "$scratch/hangs.mcap" >"$scratch/info.json" || fail "the log cannot be read"
grep -q '"hung"' "$scratch/info.json" || fail "the log does not say that it hung"
echo "a hanging layer: told, and ended by SIGTERM"
