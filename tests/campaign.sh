# A campaign with the real programs: model errors reach the simulation, a kill loses nothing, a
# search finds limits, and the campaigns that come with gaitd can be read.
source "$(dirname "$0")/common.sh"
cd "$scratch"

short_scenario 1.0 >short.yaml
cat >campaign.yaml <<'CAMPAIGN'
schema: gaitd.campaign/1
name: trial
scenarios: [short.yaml]
set: {state_estimator.variant: [kinematic_inertial, invariant_ekf]}
draw:
  model_error.mass_scale.utorso: [0.9, 1.1]
  model_error.com_offset.utorso: [[-0.03, -0.03, -0.03], [0.03, 0.03, 0.03]]
  model_error.inertia_scale.utorso: [0.9, 1.1]
  model_error.friction: [0.625, 1.25]
seeds: 2
keep_logs: 4
CAMPAIGN

gaitctl campaign campaign.yaml -o out --jobs 1 >first.txt 2>&1 &
campaign=$!
for _ in {1..600}; do
  [[ -f out/results.csv ]] && (($(wc -l <out/results.csv) >= 2)) && break
  sleep 0.05
done
kill -KILL "$campaign"
wait "$campaign" 2>/dev/null || true
expect 0 gaitctl campaign campaign.yaml -o out
(($(wc -l <out/results.csv) == 5)) || fail "expected 4 runs in results.csv"
grep -q 'campaign: passed' out/summary.txt || fail "summary: $(cat out/summary.txt)"

# A scenario that says something else makes another campaign of it; what would make all runs the same
# is refused.
cp short.yaml before.yaml
sed -i 's/^duration: .*/duration: 1.1/' short.yaml
expect 1 gaitctl campaign campaign.yaml -o out >other.txt 2>&1
grep -q 'a scenario of it' other.txt || fail "$(cat other.txt)"
cp before.yaml short.yaml
expect 0 gaitctl campaign campaign.yaml -o out
expect 1 gaitctl campaign campaign.yaml -o same --set seed=5 >same.txt 2>&1
grep -q "each run has a seed of the campaign's 'seeds'" same.txt || fail "$(cat same.txt)"
sed 's/\[kinematic_inertial, invariant_ekf\]/[invariant_ekf, invariant_ekf]/' campaign.yaml >twice.yaml
expect 1 gaitctl campaign twice.yaml -o twice >twice.txt 2>&1
grep -q 'each value once' twice.txt || fail "$(cat twice.txt)"
# A folder in which nothing can be written says so, and is none of another campaign afterwards.
said=$(
  ulimit -f 0
  trap '' XFSZ
  gaitctl campaign campaign.yaml -o full 2>&1 || true
)
[[ $said == *'campaign.yaml.new: cannot write: File too large'* ]] || fail "a full disk: $said"
[[ ! -e full/campaign.yaml ]] || fail "a campaign that was cut off stands for the whole: $(cat full/campaign.yaml)"
expect 0 gaitctl campaign campaign.yaml -o full --set toe_off.variant=never

# Another robot: the heavier of two torsos stands on more force.
force() {
  gaitctl log export "out/logs/$1.mcap" --signals 'truth/foot/*/force/z' |
    tail -1 | awk -F, '{ printf "%d", $1 + $2 }'
}
scale() { awk -F, -v run="$1" '$1 == run { print $5 }' out/results.csv; }
heavy=$(awk "BEGIN { print ($(scale 1) > $(scale 3)) }")
((heavy ? $(force 000001) > $(force 000003) : $(force 000001) < $(force 000003))) ||
  fail "scales $(scale 1) and $(scale 3) gave forces $(force 000001) and $(force 000003)"

# What no run can play is told after a few runs, not after all of them.
cat >hopeless.yaml <<'CAMPAIGN'
schema: gaitd.campaign/1
name: hopeless
scenarios: [stand]
seeds: 40
CAMPAIGN
expect 1 gaitctl campaign hopeless.yaml -o hopeless --jobs 2 --set toe_off.variant=nobody >hopeless.txt 2>&1
grep -q "none of the first 4 runs could be judged.*no variant 'nobody'" hopeless.txt || fail "$(cat hopeless.txt)"
(($(wc -l <hopeless/results.csv) < 10)) || fail "it played $(wc -l <hopeless/results.csv) runs"
! grep 'running-' hopeless/results.csv || fail "the results name a file that no longer is"

# A map of pushes in little, whose angle is the duration: a robot that gets better still holds short
# ones of any force that is tried and none of the long ones, and a picture shows it.
cat >map.yaml <<'MAP'
schema: gaitd.campaign/1
name: map
scenarios: [push-bent-forward]
set: {disturbances.0.duration: [0.02, 0.3], duration: [6]}
search: {key: disturbances.0.force, from: 300, to: 1500, count: 13, width: 250}
seeds: 12
success: no_fall
keep_logs: 0
plot: {angle: disturbances.0.duration, scale: 0.1, label: impulse (N s)}
MAP
expect 1 gaitctl campaign map.yaml -o map --set disturbances.0.force=400 >level.txt 2>&1
grep -q 'the campaign searches along it' level.txt || fail "$(cat level.txt)"
expect 0 gaitctl campaign map.yaml -o map
(($(wc -l <map/results.csv) <= 25)) || fail "expected at most 24 runs: $(cat map/results.csv)"
limits() { python3 -c 'import json; print(*(c["'"$1"'"] for c in json.load(open("map/summary.json"))["cells"]))'; }
read -r short long <<<"$(limits low)"
read -r none above <<<"$(limits high)"
[[ $none == None && $above != None ]] || fail "short and long: $(cat map/summary.txt)"
awk "BEGIN { exit !($short > 1000 && $long > 500 && $above < 1500) }" || fail "limits: $(cat map/summary.txt)"
grep -q '○ beyond what was tried' map/push-bent-forward.svg || fail "picture: $(cat map/push-bent-forward.svg)"

# Each robot is measured before its runs, once, also if that is killed the first time.
cat >motions.yaml <<'MOTIONS'
schema: gaitd.scenario/1
name: motions
robot: atlas
duration: 24.0
mode: walk-bent
commands:
  - {at: 2.0, pose: {pelvis: {z: -0.05}}}
  - {at: 5.0, pose: {pelvis: {z: -0.09, pitch: 0.1}}}
  - {at: 8.0, pose: {pelvis: {y: 0.05, z: -0.05}}}
  - {at: 11.0, pose: {pelvis: {y: -0.05, z: -0.08}}}
  - {at: 14.0, pose: {pelvis: {roll: 0.1, z: -0.08}}}
  - {at: 17.0, pose: {pelvis: {yaw: 0.15, z: -0.1}}}
  - {at: 20.0, pose: {pelvis: {x: 0.04, z: -0.05}}}
expect: {no_fall: true}
MOTIONS
cat >measured.yaml <<'MEASURED'
schema: gaitd.campaign/1
name: measured
scenarios: [short.yaml]
set:
  state_estimator.variant: [kinematic_inertial, invariant_ekf]
  drives:
    nominal: {actuators.model: nominal}
    hydraulic: {actuators.model: hydraulic, sensors.noise: lab, calibration: hydraulic}
seeds: [3]
calibrate: {motions: motions.yaml}
MEASURED
gaitctl campaign measured.yaml -o measured >first.txt 2>&1 &
campaign=$!
for _ in {1..600}; do
  compgen -G 'measured/calibrations/*.mcap' >/dev/null && break
  sleep 0.05
done
kill -KILL "$campaign"
wait "$campaign" 2>/dev/null || true
compgen -G 'measured/calibrations/*.yaml' >/dev/null && fail "a calibration that was killed has left a file"
expect 0 gaitctl campaign measured.yaml -o measured
calibrations=(measured/calibrations/*)
[[ ${#calibrations[@]} == 2 && ${calibrations[1]} == measured/calibrations/seed-3-*.yaml ]] ||
  fail "calibrations: ${calibrations[*]}"
grep -q 'zero:' "${calibrations[1]}" || fail "measured: $(cat "${calibrations[1]}")"
(($(grep -c 'hydraulic,1,' measured/results.csv) == 2)) || fail "results: $(cat measured/results.csv)"
replays=$(grep -c "\"replay\": .*calibration=${calibrations[1]#measured/}" measured/summary.json)
((replays == 2)) || fail "replays: $(grep '"replay"' measured/summary.json)"
touch -d 2020-01-01 "${calibrations[1]}"
rm measured/results.csv
expect 0 gaitctl campaign measured.yaml -o measured
[[ $(date -r "${calibrations[1]}" +%Y) == 2020 ]] || fail "what was measured was measured again"

for file in "$GAITD_SOURCE"/sim/campaigns/*.yaml; do
  # Only whether it can be read and begins.
  words=(campaign)
  grep -q '^tune:' "$file" && words+=(tune)
  interrupt_first_run gaitctl "${words[@]}" "$file" -o "$scratch/$(basename "$file")" >read.txt 2>&1
  grep -q 'interrupted' read.txt || fail "$file: $(cat read.txt)"
done
