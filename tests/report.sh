# `gaitctl report`: the page in a headless browser, from whole and cut-off logs, and its pictures.
source "$(dirname "$0")/common.sh"
cd "$scratch"
page=$GAITD_BUILD/share/gaitd/report.html
if [[ ! -f $page ]]; then
  echo "skipped: $page was not built, because npm or its registry was not there"
  exit 77
fi
playwright=$GAITD_BUILD/cli/page/npm/node_modules/playwright-core

# A minute of log opens in time, plays at the rate of the screen, and shows what was logged.
expect 0 gaitctl run estimators --log walk.mcap >run.txt
expect 0 gaitctl report walk.mcap -o walk.html
if grep -qE '(src|href)="?https?:' walk.html; then fail "the page loads something from elsewhere"; fi
grep -q "Content-Security-Policy.*default-src 'none'" walk.html || fail "the page forbids itself nothing"
expect 0 node "$GAITD_SOURCE/tests/report_page.mjs" "$playwright" "$scratch/walk.html"

# A log that was cut off at any byte opens up to there.
size=$(stat -c %s walk.mcap)
for share in 50 5; do
  head -c $((size * share / 100)) walk.mcap >cut.mcap
  expect 4 gaitctl report cut.mcap -o cut.html 2>cut.txt
  grep -q 'cut off' cut.txt || fail "nothing said of the cut: $(cat cut.txt)"
done
GAITD_NO_RATE=1 expect 0 node "$GAITD_SOURCE/tests/report_page.mjs" "$playwright" "$scratch/cut.html"
expect 0 node "$GAITD_SOURCE/tests/report_pictures.mjs" "$playwright" "$scratch/cut.html"
head -c 100 walk.mcap >none.mcap
expect 1 gaitctl report none.mcap -o none.html
[[ ! -e none.html ]] || fail "a page without a tick"
expect 1 gaitctl report missing.mcap

# One picture of the robot and one per plot, with something on it.
expect 4 gaitctl report cut.mcap -o cut.html --png pictures
for name in replay icp-path icp-x icp-y com-height knees torques forces step-adjustment tick-times; do
  (($(stat -c %s "pictures/$name.png") > 5000)) || fail "nothing on $name: $(ls -l pictures)"
  [[ $(head -c 8 "pictures/$name.png" | od -An -tx1 | tr -d ' ') == 89504e470d0a1a0a ]] ||
    fail "$name.png is no PNG"
done
(($(ls -A pictures | wc -l) == 10)) || fail "more than the pictures: $(ls -A pictures)"

# The robot as it moves: so many frames, each with something on it.
expect 4 gaitctl report cut.mcap -o cut.html --film film.png --film-span 0.2 1.1
[[ $(grep -ao fcTL film.png | wc -l) == 10 ]] || fail "frames: $(grep -ao fcTL film.png | wc -l)"
(($(stat -c %s film.png) > 50000)) || fail "nothing on the film: $(ls -l film.png)"
expect 2 gaitctl report cut.mcap --film-span 0 1 2>/dev/null

# Two logs over each other, the second robot pushed.
cat >pushed.yaml <<SCENARIO
schema: gaitd.scenario/1
name: pushed
robot: atlas
duration: 8
mode: walk-bent
commands: [{at: 2.0, walk: {steps: 2, length: 0.2}}]
disturbances: [{when: {time: 1.5}, link: pelvis, force: [0, 150, 0], duration: 0.1}]
expect: {no_fall: true}
SCENARIO
expect 0 gaitctl run pushed.yaml --log pushed.mcap >run.txt
expect 0 gaitctl report walk.mcap pushed.mcap -o two.html
expect 0 node "$GAITD_SOURCE/tests/report_two.mjs" "$playwright" "$scratch/two.html"
expect 4 gaitctl --json report walk.mcap cut.mcap -o damaged.html >damaged.json 2>cut.txt
grep -q '"logs"' damaged.json || fail "nothing of each log: $(cat damaged.json)"

# A robot whose links have no shapes, or meshes only, is drawn as sticks.
python3 "$GAITD_SOURCE/tests/made_up_robots.py" urdf tilted
expect 0 gaitctl robot init urdf/tilted/tilted.urdf -o tilted >init.txt
expect 0 gaitctl run tilted/stand.yaml --log sticks.mcap >run.txt
expect 0 gaitctl report sticks.mcap -o sticks.html
expect 0 node "$GAITD_SOURCE/tests/report_sticks.mjs" "$playwright" "$scratch/sticks.html" 1.1
