# A walk in lockstep, daemon and plant together, takes little of one processor: its seconds over those
# of the processor, which a busy machine changes little. docs/performance.md has the figure.
source "$(dirname "$0")/common.sh"
bound=2.0

core=$(taskset -cp $$ | sed -E 's/.*: ([0-9]+).*/\1/')
TIMEFORMAT='%U %S'
{ time taskset -c "$core" gaitctl run flat-0.35 --log "$scratch/walk.mcap" >"$scratch/out" 2>&1; } \
  2>"$scratch/time" || cat "$scratch/out"
seconds=$(awk '{ print $1 + $2 }' "$scratch/time")
factor=$(awk '$1 == "realtime_factor" { print $2 }' "$scratch/out")
duration=$(awk '$1 == "duration" { print $2 }' "$scratch/out")
[[ -n $factor ]] || fail "the verdict has no realtime_factor"
echo "$duration s of flat-0.35 in $seconds s of a processor, the verdict with it; realtime_factor $factor"
awk -v s="$seconds" -v b="$bound" -v d="$duration" 'BEGIN { exit !(d > 10 && d > b * s) }' ||
  fail "too slow, at least $bound times faster than real time wanted; or the walk ended early"
