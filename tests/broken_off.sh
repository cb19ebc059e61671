# The run of a scenario that somebody ends before it is over does not pass, though nothing fell; nor does
# one that ends in a fault, however late that comes.
source "$(dirname "$0")/common.sh"

cat >"$scratch/long.yaml" <<SCENARIO
schema: gaitd.scenario/1
name: long
robot: atlas
duration: 3000
mode: walk-bent
terrain: {friction: 0.8, ground_z: 0}
commands:
  - {at: 2900, walk: {steps: 2, length: 0.1, swing: 0.6, transfer: 0.25}}
expect: {no_fall: true}
SCENARIO
gaitctl run "$scratch/long.yaml" --log "$scratch/long.mcap" >"$scratch/verdict" 2>&1 &
run=$!
for _ in {1..300}; do
  size=$(stat -c %s "$scratch/long.mcap" 2>/dev/null || echo 0)
  ((size > 100000)) && break
  sleep 0.1
done
((size > 100000)) || fail "no log after 30 s: $(cat "$scratch/verdict")"
kill -TERM "$(pgrep -P "$run" -x gaitd)"
code=0
wait "$run" || code=$?
((code == 1)) || fail "gaitctl run ended with exit code $code: $(cat "$scratch/verdict")"
grep -q 'ok  *no_fall' "$scratch/verdict" || fail "it fell: $(cat "$scratch/verdict")"
grep -q 'FAIL  *played_to_the_end  *stopped' "$scratch/verdict" || fail "$(cat "$scratch/verdict")"

cat >"$scratch/late.yaml" <<SCENARIO
schema: gaitd.scenario/1
name: late
robot: atlas
duration: 2
mode: walk-bent
commands:
  - {at: 1.7, estop: true}
expect: {no_fall: true}
SCENARIO
expect 1 gaitctl run "$scratch/late.yaml" --log "$scratch/late.mcap" >"$scratch/verdict" 2>&1
grep -q 'ok  *no_fall' "$scratch/verdict" || fail "it fell: $(cat "$scratch/verdict")"
grep -q 'FAIL  *played_to_the_end  *fault' "$scratch/verdict" || fail "$(cat "$scratch/verdict")"

# What gaitd prints has its place beside the log, and is nobody else's file.
echo precious >"$scratch/late.txt"
expect 1 gaitctl run "$scratch/late.yaml" --log "$scratch/late.mcap" >/dev/null 2>&1
[[ $(cat "$scratch/late.txt") == precious ]] || fail "a run overwrote late.txt"
grep -q 'e-stop\|estop' "$scratch/late.mcap.txt" || fail "nothing of gaitd beside the log: $(ls "$scratch")"
echo "a run that was broken off fails"
