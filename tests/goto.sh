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
# twice SCENARIO NAME WHAT: two runs at once and a replay of the first have the same bits.
twice() {
  local first=0 log
  gaitctl run "$1" --log "$2a.mcap" >"$2a.out" 2>&1 &
  expect 0 gaitctl run "$1" --log "$2b.mcap"
  wait $! || first=$?
  ((first == 0)) || fail "$(cat "$2a.out")"
  for log in "$2a" "$2b"; do
    gaitctl log export "$log.mcap" --signals 'time,icp/*,pelvis/*,joint/*/position' -o "$log.csv"
  done
  cmp "$2a.csv" "$2b.csv" || fail "two runs with $3 differ"
  expect 0 gaitctl log replay "$2a.mcap"
}
twice there.yaml '' 'a goto'
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

# ---- Ground that is seen: two runs and a replay have the same bits, the report shows the map, and what the camera
# saw is what there is.
cat >seen.yaml <<SCENARIO
schema: gaitd.scenario/1
name: seen
robot: atlas
duration: 40
seed: 3
mode: walk-straight
sensors: {noise: nominal}
actuators: {model: nominal}
terrain: {height_map: $GAITD_SOURCE/sim/scenarios/maps/stairs-and-slope.yaml}
perception: {sensor: depth_camera}
commands:
  - {at: 1.0, goto: {x: 2.3, y: 0.1, yaw: 0.0}}
expect: {no_fall: true, final_pelvis: {x: 2.3, y: 0.1, tolerance: 0.15}}
SCENARIO
twice seen.yaml s 'a camera'
gaitctl log info sa.mcap --json >info.json
python3 - info.json <<'CHECK' || fail "the end of the goto is not told: $(grep goto info.json)"
import json, sys
texts = [str(event.get("text")) for event in json.load(open(sys.argv[1]))["events"]]
sys.exit(not any("goto: arrived, 0.0" in text for text in texts))
CHECK
expect 0 gaitctl report sa.mcap -o seen.html
grep -q '\\"heights\\"' seen.html || fail "the report has no map"

# A walk that believes the field is level is put on what the camera sees: the capture point errs by less than half.
error_of() { sed -n 's/^ *icp_error_rms *\([0-9.]*\) m.*/\1/p' "$1" | head -1; }
expect 0 gaitctl run blind-field-2 -v --log blind.mcap >blind.out
expect 0 gaitctl run blind-field-2 --set perception.sensor=depth_camera -v --log seeing.mcap >seeing.out
python3 -c "import sys; sys.exit(not 2 * float('$(error_of seeing.out)') < float('$(error_of blind.out)'))" ||
  fail "blind $(error_of blind.out), seeing $(error_of seeing.out)"

# Where there is no way it looks for one, and then stands and says so: four walls around the goal.
walls="{center: [1.8, 0, 0.5], size: [0.1, 1.6, 1]}, {center: [3.2, 0, 0.5], size: [0.1, 1.6, 1]}"
walls+=", {center: [2.5, 0.75, 0.5], size: [1.4, 0.1, 1]}, {center: [2.5, -0.75, 0.5], size: [1.4, 0.1, 1]}"
sed "s/^terrain: .*/terrain: {ground_z: 0, boxes: [$walls]}/; s/x: 2.3, y: 0.1, yaw: 0.0/x: 2.5, y: 0/;
  s/^duration: .*/duration: 90/; s/^expect: .*/expect: {no_fall: true, final_pelvis: {x: 3, y: 0, tolerance: 6}}/" seen.yaml >wall.yaml
expect 0 gaitctl run wall.yaml --log wall.mcap
gaitctl log info wall.mcap --json >info.json
grep -q 'goto: given up' info.json || fail "nobody says that there is no way: $(grep goto info.json)"

# ---- Tiles from another process.
start_daemon --clock realtime --log tiles.mcap
wait_for state standing 60
expect 1 gaitctl map save none.yaml 2>said
grep -q 'knows nothing' said || fail "$(cat said)"
expect 0 gaitctl map put "$GAITD_SOURCE/sim/scenarios/maps/stairs-and-slope.yaml" | tee said
grep -q 'of 60000 cells taken; [0-9]* are too far from the robot$' said || fail "$(cat said)"
expect 0 gaitctl map save known.yaml
python3 - known.yaml <<'CHECK' || fail "$(cat known.yaml)"
import sys
text = open(sys.argv[1]).read()
sys.exit("resolution: 0.02" not in text)
CHECK
expect 0 gaitctl goto -- -4 0 | tee said
grep -q 'to where the ground is not known yet' said || fail "$(cat said)"
expect 0 gaitctl stop
wait_for state standing 60
expect 0 gaitctl goto 0.3 0.0
wait_for state standing 60
expect 0 gaitctl map clear
expect 1 gaitctl map save none.yaml 2>said
stop_daemon
