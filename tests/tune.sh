# `gaitctl campaign tune` with the real programs: a kill loses nothing, what is held out is played by the winner and
# the defaults alone, and gaitd takes what was found.
source "$(dirname "$0")/common.sh"
cd "$scratch"

short_scenario 1.0 >short.yaml
cat >step.yaml <<'STEP'
schema: gaitd.scenario/1
name: step
robot: atlas
duration: 3.6
mode: walk-bent
sensors: {noise: nominal}
actuators: {model: nominal}
commands: [{at: 0.6, walk: {steps: 1, length: 0.3}}]
expect: {no_fall: true}
STEP
cat >tune.yaml <<'TUNE'
schema: gaitd.campaign/1
name: trial
scenarios: [step.yaml]
draw: {model_error.mass_scale.utorso: [0.95, 1.05]}
seeds: 1
keep_logs: 0
tune:
  parameters: {step_adjuster.gain_parallel: 30 %, objectives.swing_stiffness: [110, 220]}
  objective: {icp_error_rms: 1}
  generations: 2
  population: 5
  held_out: {seeds: 2}
TUNE
gaitctl campaign tune tune.yaml -o tuned >first.txt 2>&1 &
tuning=$!
for _ in {1..600}; do
  [[ -f tuned/generation-01/results.csv ]] && (($(wc -l <tuned/generation-01/results.csv) >= 3)) && break
  sleep 0.05
done
kill -KILL "$tuning"
wait "$tuning" 2>/dev/null || true
code=0
gaitctl campaign tune tune.yaml -o tuned >second.txt 2>&1 || code=$?
((code <= 1)) || fail "exit code $code: $(cat second.txt)"
grep -q 'goes on: [2-9] of 6 runs are done' second.txt || fail "it does not go on: $(cat second.txt)"
(($(wc -l <tuned/candidates.csv) == 13)) || fail "candidates: $(cat tuned/candidates.csv)"
grep -q '^1,default,4,' tuned/candidates.csv || fail "no defaults: $(cat tuned/candidates.csv)"
grep -q 'on what it never saw: of 2 pairs' tuned/summary.txt || fail "summary: $(cat tuned/summary.txt)"
(($(wc -l <tuned/held-out/results.csv) == 5)) || fail "held out: $(cat tuned/held-out/results.csv)"
expect 0 gaitd --check-config tuned/winner.yaml
expect "$code" gaitctl campaign tune tune.yaml -o tuned >again.txt 2>&1
[[ $(grep -c '^generation' again.txt) == 0 ]] || fail "played again: $(cat again.txt)"
expect 0 gaitctl campaign report tuned/held-out -o page.html

# A search in a campaign of the real programs is in campaign.sh; the page of one is here.
cat >search.yaml <<'SEARCH'
schema: gaitd.campaign/1
name: search
scenarios: [short.yaml]
set: {sensors.noise: [none, nominal], gait.swing_duration: [0.6, 0.7]}
search: {key: model_error.friction, from: 1.0, to: 0.5}
seeds: 8
keep_logs: 0
SEARCH
expect 0 gaitctl campaign search.yaml -o search
grep -q '≤ 0.5' search/summary.txt || fail "summary: $(cat search/summary.txt)"
expect 0 gaitctl campaign report search -o search.html
playwright=$GAITD_BUILD/cli/page/npm/node_modules/playwright-core
[[ -d $playwright ]] || exit 0
expect 0 node "$GAITD_SOURCE/tests/search_page.mjs" "$playwright" "$scratch/search.html"
