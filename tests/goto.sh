# `gaitctl goto` in real time and in lockstep: it arrives, is replaced, gives way to a stop and says why there
# is no way; two runs and a replay have the same bits.
source "$(dirname "$0")/common.sh"
cd "$scratch"

cat >there.yaml <<SCENARIO
schema: gaitd.scenario/1
name: there
robot: atlas
duration: 25
seed: 2
mode: walk-straight
sensors: {noise: nominal}
actuators: {model: nominal}
terrain: {height_map: $GAITD_SOURCE/sim/scenarios/maps/stairs-and-slope.yaml}
commands:
  - {at: 1.0, goto: {x: 1.6, y: 0.2, yaw: 0.0}}
  - {at: 4.35, goto: {x: 1.2, y: -0.2, yaw: 0.0}}
expect: {no_fall: true, final_pelvis: {x: 1.2, y: -0.2, tolerance: 0.15}}
SCENARIO
first=0
gaitctl run there.yaml --log a.mcap >a.out 2>&1 &
expect 0 gaitctl run there.yaml --log b.mcap
wait $! || first=$?
((first == 0)) || fail "$(cat a.out)"
for log in a b; do
  gaitctl log export $log.mcap --signals 'time,icp/*,pelvis/*,joint/*/position' -o $log.csv
done
cmp a.csv b.csv || fail "two runs with a goto differ"
expect 0 gaitctl log replay a.mcap
# Nobody asked for a place behind the map.
sed 's/x: 1.6, y: 0.2/x: 16, y: 0/; s/^expect: .*/expect: {refused_commands: 1, no_fall: true}/' there.yaml >nowhere.yaml
expect 0 gaitctl run nowhere.yaml --log nowhere.mcap

start_daemon --clock realtime --log live.mcap
wait_for state standing 60
expect 2 gaitctl goto 1
expect 0 gaitctl goto 0 0 0 | tee said
grep -q 'nothing to do' said || fail "it stands there: $(cat said)"
expect 0 gaitctl goto -- -0.3 0.2 0.1 | tee said
grep -q 'footsteps, about' said || fail "$(cat said)"
expect 0 gaitctl goto 0.2 0
wait_for state standing 60
gaitctl --json status >status.json
python3 - status.json <<'CHECK' || fail "it stands elsewhere: $(cat status.json)"
import json, sys
feet = json.load(open(sys.argv[1]))["feet"]
x, y = (sum(feet[side][axis] for side in ("left", "right")) / 2 for axis in ("x", "y"))
sys.exit(abs(x - 0.2) > 0.05 or abs(y) > 0.05)
CHECK
expect 0 gaitctl goto 2 0
expect 0 gaitctl stop
wait_for state standing 60
expect 0 gaitctl mode stand
expect 1 gaitctl goto 2 0 2>said
grep -q 'mode is stand' said || fail "$(cat said)"
stop_daemon
