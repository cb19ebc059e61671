# Two runs in lockstep give the same bits: every signal of every tick is equal but wall times.
source "$(dirname "$0")/common.sh"

# At the same time, so that they disturb each other.
first=0 second=0
gaitctl run flat-0.35 --log "$scratch/a.mcap" >"$scratch/a.out" 2>&1 &
gaitctl run flat-0.35 --log "$scratch/b.mcap" >"$scratch/b.out" 2>&1 || second=$?
wait $! || first=$?
((first == second)) || fail "exit codes differ: $first and $second"

gaitctl log export "$scratch/a.mcap" --signals 'time,tick*,wbc/*,*' -o "$scratch/all.csv"
signals=$(head -n 1 "$scratch/all.csv" | tr ',' '\n' | grep -vE '^(tick/.*|wbc/solve_us)$' |
  paste -sd ,)
rm "$scratch/all.csv"
for log in a b; do
  gaitctl log export "$scratch/$log.mcap" --signals "$signals" -o "$scratch/$log.csv"
done
rows=$(wc -l <"$scratch/a.csv")
columns=$(tr ',' '\n' <<<"$signals" | wc -l)
((rows > 1000 && columns > 100)) || fail "only $rows rows of $columns signals in the log"
if ! cmp "$scratch/a.csv" "$scratch/b.csv"; then
  diff <(head -n 20000 "$scratch/a.csv" | cut -d , -f 1-20) \
    <(head -n 20000 "$scratch/b.csv" | cut -d , -f 1-20) | head -n 4 >&2 || true
  fail "two runs of flat-0.35 differ"
fi
echo "$rows rows of $columns signals are identical"
