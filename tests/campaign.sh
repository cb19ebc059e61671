# A campaign with the real programs: model errors reach the simulation, a kill loses nothing, and
# the campaigns that come with gaitd can be read.
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

for file in "$GAITD_SOURCE"/sim/campaigns/*.yaml; do
  # Stopped before the first run ends: only whether it can be read and started.
  code=0
  timeout -s INT 2 gaitctl campaign "$file" -o "$scratch/$(basename "$file")" >read.txt 2>&1 || code=$?
  grep -q 'interrupted' read.txt || fail "$file: $(cat read.txt)"
done
