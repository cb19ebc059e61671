# `gaitctl compare`: one scenario under two configurations, figures side by side, each as a run with
# that configuration gives it.
source "$(dirname "$0")/common.sh"
cd "$scratch"

cat >short.yaml <<'SCENARIO'
schema: gaitd.scenario/1
name: short
robot: atlas
duration: 6
seed: 1
mode: walk-straight
commands: [{at: 0.5, walk: {steps: 2, length: 0.3}}]
expect: {no_fall: true, steps_taken: 2, toe_off_steps_min: 1}
SCENARIO
printf 'schema: gaitd.config/1\n' >rolls.yaml
printf 'schema: gaitd.config/1\ntoe_off: {variant: never}\n' >flat.yaml

gaitctl --json compare short.yaml --log logs -- rolls.yaml flat.yaml >both.json || fail "compare: exit code $?"
figure() { # FILE NAME PLACE: place is 0 or 1 in a comparison
  node -e '
    const all = JSON.parse(require("fs").readFileSync(process.argv[1]))
    const figure = all.figures[process.argv[2]]
    console.log(Array.isArray(figure) ? figure[process.argv[3]] : figure)' "$@"
}
[[ $(figure both.json toe_off_steps 0) -ge 1 ]] || fail "no toe-off with the first configuration"
[[ $(figure both.json toe_off_steps 1) == 0 ]] || fail "toe-off with the second configuration"
[[ $(figure both.json swings 0) == $(figure both.json swings 1) ]] || fail "not the same steps"
gaitctl log export logs/b-flat.mcap --signals time,pelvis/x -o compared.csv
expect 1 gaitctl run short.yaml --set toe_off.variant=never --log alone.mcap >/dev/null 2>&1
gaitctl log export alone.mcap --signals time,pelvis/x -o alone.csv
cmp compared.csv alone.csv || fail "not what a run with that configuration gives"

expect 0 gaitctl compare short.yaml -- rolls.yaml flat.yaml >table.txt 2>/dev/null
grep -qE '^short.yaml +rolls +flat +change' table.txt || fail "no heading: $(head -n 1 table.txt)"
grep -qE '^toe_off_steps +[1-9] +0 +-100' table.txt || fail "$(grep toe_off table.txt)"
grep -qE '^expect toe_off_steps_min .* ok .* FAIL' table.txt || fail "$(grep expect table.txt)"

printf 'schema: gaitd.config/1\ntoe_off: {variant: nevr}\n' >wrong.yaml
expect 1 gaitctl compare short.yaml -- rolls.yaml wrong.yaml >/dev/null 2>wrong.txt
grep -q 'never' wrong.txt || fail "the error does not say what there is: $(cat wrong.txt)"
expect 1 gaitctl compare short.yaml -- rolls.yaml missing.yaml >/dev/null 2>&1
expect 2 gaitctl compare short.yaml -- rolls.yaml 2>/dev/null
