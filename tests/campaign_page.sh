# `gaitctl campaign report`: the page in a headless browser. From each point to the run, what the doctor says of
# it and its replay.
source "$(dirname "$0")/common.sh"
cd "$scratch"
page=$GAITD_BUILD/share/gaitd/campaign.html
if [[ ! -f $page ]]; then
  echo "skipped: $page was not built, because npm or its registry was not there"
  exit 77
fi
playwright=$GAITD_BUILD/cli/page/npm/node_modules/playwright-core

cat >pushed.yaml <<'SCENARIO'
schema: gaitd.scenario/1
name: pushed
robot: atlas
duration: 2.5
mode: walk-bent
disturbances: [{when: {time: 1.2}, link: pelvis, force: [0, 150, 0], duration: 0.1}]
expect: {no_fall: true}
SCENARIO
cat >pushes.yaml <<'CAMPAIGN'
schema: gaitd.campaign/1
name: pushes
scenarios: [pushed.yaml]
set:
  step_adjuster.variant: [step_plan, fixed_steps]
  disturbances.0.direction: [0, 1.5708]
draw: {disturbances.0.force: [150, 2500]}
seeds: 3
keep_logs: 2
plot: {angle: disturbances.0.direction, curves: step_adjuster.variant}
CAMPAIGN
gaitctl campaign pushes.yaml -o pushes >run.txt 2>&1 || grep -q 'campaign: FAILED' run.txt || fail "$(cat run.txt)"
expect 0 gaitctl campaign report pushes -o page.html
if grep -qE '(src|href)="?https?:' page.html; then fail "the page loads something from elsewhere"; fi
grep -q "Content-Security-Policy.*default-src 'none'" page.html || fail "the page forbids itself nothing"
expect 0 node "$GAITD_SOURCE/tests/campaign_page.mjs" "$playwright" "$scratch/page.html"
expect 0 gaitctl campaign report pushes -o again.html
cmp page.html again.html || fail "the same results are another page"
# As docs/campaigns.md has it.
ln -s pushes push-map-results
ln -s pushes gauntlet-results
mapfile -t lines < <(grep '^gaitctl campaign report' "$GAITD_SOURCE/docs/campaigns.md")
((${#lines[@]} == 2)) || fail "docs/campaigns.md has ${#lines[@]} commands of the page"
for line in "${lines[@]}"; do
  read -ra words <<<"$line"
  expect 0 "${words[@]}"
done
(($(find gauntlet-replays -name '*.html' | wc -l) == 2)) || fail "replays: $(ls gauntlet-replays)"
expect 1 gaitctl campaign report . -o none.html 2>/dev/null
[[ ! -e none.html ]] || fail "a page of nothing"
