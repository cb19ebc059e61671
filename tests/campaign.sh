# A campaign with the real programs: model errors reach the simulation, a kill loses nothing, a
# search finds what is held, and the campaigns that come with gaitd can be read.
source "$(dirname "$0")/common.sh"
cd "$scratch"

cat >short.yaml <<'SCENARIO'
schema: gaitd.scenario/1
name: short
robot: atlas
duration: 1.0
seed: 1
mode: walk-bent
sensors: {noise: nominal}
expect: {no_fall: true}
SCENARIO
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

# Another robot: the heavier of two torsos stands on more force.
force() {
  gaitctl log export "out/logs/$1.mcap" --signals 'truth/foot/*/force/z' |
    tail -1 | awk -F, '{ printf "%d", $1 + $2 }'
}
scale() { awk -F, -v run="$1" '$1 == run { print $5 }' out/results.csv; }
heavy=$(awk "BEGIN { print ($(scale 1) > $(scale 3)) }")
((heavy ? $(force 000001) > $(force 000003) : $(force 000001) < $(force 000003))) ||
  fail "scales $(scale 1) and $(scale 3) gave forces $(force 000001) and $(force 000003)"

# A map of pushes in little: forwards it recovers from more than sideways, and a picture shows it.
cat >map.yaml <<'MAP'
schema: gaitd.campaign/1
name: map
scenarios: [push-bent-forward]
set: {disturbances.0.direction: [0, 1.5708], duration: [6]}
search: {key: disturbances.0.force, from: 300, to: 1300, count: 3}
success: no_fall
plot: {angle: disturbances.0.direction, scale: 0.1, label: impulse (N s)}
MAP
expect 0 gaitctl campaign map.yaml -o map
(($(wc -l <map/results.csv) == 5)) || fail "expected 4 runs: $(cat map/results.csv)"
largest() { awk -v angle="direction=$1 " '$1 == "push-bent-forward" && index($0, angle) { print $2 }' map/summary.txt; }
(($(largest 0) == 1300 && $(largest 1.5708) == 800)) || fail "summary: $(cat map/summary.txt)"
grep -q '<polygon points="160.0,[0-9.]* [0-9.]*,190.0 "' map/push-bent-forward.svg ||
  fail "picture: $(cat map/push-bent-forward.svg)"

for file in "$GAITD_SOURCE"/sim/campaigns/*.yaml; do
  # Stopped before the first run ends: only whether it can be read and started.
  code=0
  timeout -s INT 2 gaitctl campaign "$file" -o "$scratch/$(basename "$file")" >read.txt 2>&1 || code=$?
  grep -q 'interrupted' read.txt || fail "$file: $(cat read.txt)"
done
