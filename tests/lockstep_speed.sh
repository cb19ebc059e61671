# A walk in lockstep on one core is at least this many times faster than real time. A bound that a
# busy machine keeps; the figure itself is printed.
source "$(dirname "$0")/common.sh"
bound=1.5

core=$(taskset -cp $$ | sed -E 's/.*: ([0-9]+).*/\1/')
taskset -c "$core" gaitctl run flat-0.35 --log "$scratch/walk.mcap" >"$scratch/out" 2>&1 ||
  cat "$scratch/out"
factor=$(awk '$1 == "realtime_factor" { print $2 }' "$scratch/out")
duration=$(awk '$1 == "duration" { print $2 }' "$scratch/out")
[[ -n $factor ]] || fail "the verdict has no realtime_factor"
echo "realtime_factor $factor on one core, over $duration s of flat-0.35; at least $bound wanted"
awk -v f="$factor" -v b="$bound" -v d="$duration" 'BEGIN { exit !(f >= b && d > 10) }' ||
  fail "too slow, or the walk ended early"
