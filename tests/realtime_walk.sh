# Half a minute of walking in real time, commanded over the socket as a user does.
source "$(dirname "$0")/common.sh"
socket=$scratch/own.sock
client=(gaitctl --socket "$socket")

command() { expect 0 "${client[@]}" "$@"; }

start_daemon --clock realtime --socket "$socket" --log "$scratch/walk.mcap"
wait_for state standing 20
[[ $(field clock) == realtime ]] || fail "the clock is $(field clock)"

# Idle processors stay awake for as long as it runs, where the machine has something to say for it.
if [[ -w /dev/cpu_dma_latency ]]; then
  ls -l "/proc/$daemon/fd" | grep -q /dev/cpu_dma_latency ||
    fail "it does not hold /dev/cpu_dma_latency: $(grep 'real time' "$scratch/gaitd.txt")"
fi

command walk --steps 14 --length 0.3 --swing 0.6 --transfer 0.25
wait_for state walking 5
wait_for step_index 3 30
command status
command pause
wait_for phase stand 20
sleep 2
[[ $(field phase) == stand ]] || fail "it walks on though it was told to pause"
command resume
wait_for phase swing 20
wait_for state standing 60

# Explicit footsteps, a wider stance where the walk ended: 14 steps of 0.3 m.
cat >"$scratch/steps.yaml" <<STEPS
- {side: right, x: 4.2, y: -0.14, swing: 0.7, transfer: 0.3}
- {side: left, x: 4.2, y: 0.14, swing: 0.7, transfer: 0.3}
STEPS
command steps "$scratch/steps.yaml"
wait_for state walking 5
wait_for state standing 30

before=$(field step_index)
command walk --steps 12 --length -0.2
wait_for step_index $((before + 5)) 90
command stop
wait_for state standing 30
[[ $(field faults) == none ]] || fail "faults: $(field faults)"
time=$(field time)
command status
stop_daemon

awk -v t="$time" 'BEGIN { exit !(t >= 20) }' || fail "only $time s of control"
gaitctl log info "$scratch/walk.mcap" >"$scratch/info.txt"
grep -q 'state *finished' "$scratch/info.txt" || fail "the log is not complete"
grep 'times real time' "$scratch/gaitd.txt"
