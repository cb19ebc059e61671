# CAN sockets as the kernel has them: frames of both sizes, filters, stamps, overflow, down and up,
# bus-off. Then that floating-point state survives the context switches inside User-Mode Linux: a
# walk in lockstep gives the same bits inside, twice at once, and outside.
source "$(dirname "$0")/uml.sh"
uml_start_or_skip
uml_run can_bus_inside.sh 600

gaitctl run "$here/short_walk.yaml" --log "$scratch/outside.mcap" >"$scratch/outside.txt" 2>&1 ||
  fail "the walk fails outside: $(tail -n 5 "$scratch/outside.txt")"
uml_run same_bits_inside.sh 600
signals=$(gaitctl log export "$scratch/outside.mcap" --signals 'time,tick*,*' -o - 2>/dev/null | head -n 1 |
  tr ',' '\n' | grep -vE '^(tick/.*|wbc/solve_us)$' | paste -sd ,) || true
for log in outside inside1 inside2; do
  gaitctl log export "$scratch/$log.mcap" --signals "$signals" -o "$scratch/$log.csv"
done
rows=$(wc -l <"$scratch/outside.csv")
((rows > 1000)) || fail "only $rows rows"
for log in inside1 inside2; do
  cmp "$scratch/outside.csv" "$scratch/$log.csv" || fail "$log differs from outside"
done
echo "$rows ticks are identical inside and outside"
