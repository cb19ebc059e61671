# A few scenarios of the gauntlet: they are walked, counted by kind, and the worst can be played again;
# nobody passes who does not arrive. All of it: gaitctl campaign sim/campaigns/gauntlet.yaml.
source "$(dirname "$0")/common.sh"
cd "$scratch"

# slice KINDS SEEDS: the gauntlet with these kinds and seeds only.
slice() {
  awk -v kinds="$1" -v seeds="$2" '
    /^gauntlet:/ { print "gauntlet: [" kinds "]"; skip = 1; next }
    skip && /^ / { next }
    { skip = 0 }
    /^seeds:/ { print "seeds: [" seeds "]"; next }
    { print }' "$GAITD_SOURCE/sim/campaigns/gauntlet.yaml" >slice.yaml
}
settings=(--set mode=walk-straight --set drives=nominal
  --set state_estimator.variant=kinematic_inertial)

slice 'curve, stairs-down, unknown-steps, push-walking' 1
expect 0 gaitctl campaign slice.yaml -o out "${settings[@]}"
for kind in curve stairs-down unknown-steps push-walking; do
  grep -q "^walk-straight  nominal  $kind  *1/1  *100.0 %  20.7 % .. 100.0 %" out/summary.txt ||
    fail "no rate of $kind: $(cat out/summary.txt)"
done
grep -q '^  ok .*drives=nominal 4/4' out/summary.txt || fail "targets: $(cat out/summary.txt)"

# The worst again, to the bit: the same largest error of the capture point.
replay=$(sed -n 's/^the worst again, from this folder: //p' out/summary.txt)
[[ $replay == "gaitctl run scenarios/"* ]] || fail "no command: $(cat out/summary.txt)"
(cd out && eval "${replay/gaitctl/gaitctl --json}") >again.json
error=$(sed -n 's/.*"icp_error_max": \([0-9.]*\).*/\1/p' again.json | head -1)
grep -q ",$(printf '%.6g' "$error")," out/results.csv || fail "$error is not in $(cat out/results.csv)"

# Steps on the spot are steps, but lead nowhere.
slice flat 1
expect 1 gaitctl campaign slice.yaml -o still "${settings[@]}" --set commands.0.walk.length=0
grep -q 'not held: final_pelvis' still/summary.txt || fail "summary: $(cat still/summary.txt)"

# The commands of docs/gauntlet.md are understood: stopped in the first run.
count=0
while read -r line; do
  ((count += 1))
  # shellcheck disable=SC2086
  (cd "$GAITD_SOURCE" && interrupt_first_run $line -o "$scratch/page$count") >read.txt 2>&1
  grep -q interrupted read.txt || fail "$line: $(cat read.txt)"
done < <(sed -n 's/^\(gaitctl campaign [^ ]*\( --set [^ ]*\)*\).*/\1/p' "$GAITD_SOURCE/docs/gauntlet.md")
((count >= 4)) || fail "docs/gauntlet.md has $count commands"
