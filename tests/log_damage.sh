# A damaged log: every reader says what is missing and ends with 4; a sound one ends with 0. A log
# that is removed while it is written is an error of the run.
source "$(dirname "$0")/common.sh"
cd "$scratch"
gaitctl run stand --set duration=2 --log walk.mcap >run.txt 2>&1 || { cat run.txt; fail "no log"; }
for reader in "log info" "log info --signals" "log export" "log replay" doctor; do
  expect 0 gaitctl $reader walk.mcap >out.txt 2>err.txt
  [[ ! -s err.txt ]] || fail "gaitctl $reader of a sound log says: $(cat err.txt)"
done
size=$(stat -c %s walk.mcap)

# overwrite FILE BYTE TEXT
overwrite() { printf '%s' "$3" | dd of="$1" bs=1 seek="$2" conv=notrunc status=none; }
# told TEXT COMMAND...: ends with 4 and says TEXT.
told() {
  expect 4 gaitctl "${@:2}" >out.txt 2>err.txt || { cat out.txt err.txt; fail "see above"; }
  grep -q "damaged: .*$1" err.txt || { cat err.txt; fail "no '$1' from gaitctl ${*:2}"; }
}
readers() {
  told "$1" log info "$2"
  told "$1" log info --signals "$2"
  told "$1" log export "$2" -o out.csv
  told "$1" log replay "$2"
  told "$1" doctor "$2"
  if [[ -f $GAITD_BUILD/share/gaitd/report.html ]]; then told "$1" report "$2" -o out.html; fi
}
cp walk.mcap middle.mcap
# 20 kB: an index of messages that stands between two chunks, at most 8 kB, cannot hold all of it,
# and without an index no tick is lost.
overwrite middle.mcap $((size * 3 / 4)) "$(printf 'not what was written here%.0s' {1..800})"
readers 'ticks are missing: ' middle.mcap
rows=$(($(wc -l <out.csv) - 1))
expect 4 gaitctl --json log export middle.mcap -o out.csv >out.json 2>err.txt
lost=$(grep -o '"lost_ticks": [0-9]*' out.json | grep -o '[0-9]*')
whole=$(($(gaitctl log export walk.mcap | wc -l) - 1))
((lost > 0 && rows + lost == whole)) || fail "$rows rows and $lost lost, of $whole"

head -c $((size * 2 / 3)) walk.mcap >cut.mcap
readers 'cut off at byte' cut.mcap
cp walk.mcap end.mcap
overwrite end.mcap $((size - 200)) 'not this'
told 'summary' log info end.mcap

# A log that somebody takes away.
start_daemon --clock realtime --log gone.mcap
wait_for state standing 60
rm gone.mcap
for _ in {1..100}; do
  gaitctl --json status >status.json
  grep -q '"error": *"[^"]*removed or renamed' status.json && break
  sleep 0.1
done
grep -q '"error": *"[^"]*removed or renamed' status.json || fail "$(grep -A8 '"log"' status.json)"
grep -q '"open": *false' status.json || fail "the log is called open"
[[ $(field state) == standing ]] || fail "the robot is $(field state)"
stop_daemon 1
grep -q 'the log is not complete' gaitd.txt || fail "gaitd ends without a word about the log"
echo "damage is told"
