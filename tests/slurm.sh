# A campaign on a real Slurm of two nodes, one of which dies: --resume plays what it took with it, and
# the folder is that of one machine, to the byte. Shards that somebody else started give the same.
source "$(dirname "$0")/common.sh"
source "$(dirname "$0")/slurm_cluster.sh"
why=$(why_no_cluster)
if [[ -n $why ]]; then
  echo "skipped: $why"
  exit 77
fi
trap 'stop_cluster; clean_up' EXIT
cd "$scratch"

short_scenario 1.0 >short.yaml
cat >campaign.yaml <<'CAMPAIGN'
schema: gaitd.campaign/1
name: trial
scenarios: [short.yaml]
set: {state_estimator.variant: [kinematic_inertial, invariant_ekf]}
draw: {model_error.mass_scale.utorso: [0.9, 1.1]}
seeds: 4
keep_logs: 2
CAMPAIGN

expect 0 gaitctl campaign campaign.yaml -o local >local.txt

# same FOLDER: as one machine has it.
same() {
  local file
  for file in campaign.yaml results.csv summary.txt summary.json; do
    cmp "local/$file" "$1/$file" || fail "$1/$file is not that of one machine"
  done
  [[ $(cd local/logs && ls *.mcap) == $(cd "$1/logs" && ls *.mcap) ]] || fail "logs: $(ls "$1/logs")"
}

# As docs/cluster.md has it.
mapfile -t lines < <(commands_of docs/cluster.md)
((${#lines[@]} == 5)) || fail "docs/cluster.md has ${#lines[@]} lines of commands"
read -ra submit <<<"${lines[0]}"
read -ra resume <<<"${lines[1]}"
read -ra first <<<"${lines[2]}"
read -ra second <<<"${lines[3]}"
read -ra merge <<<"${lines[4]}"

# Any other engine: shards in any order, one after it was killed.
expect 0 "${second[@]}" >second.txt
grep -q 'shard 2/2: 4 of 4 runs, 0 failed' second.txt || fail "$(cat second.txt)"
"${first[@]}" --jobs 1 >first.txt 2>&1 &
shard=$!
for _ in {1..600}; do
  [[ -f part-1/results.csv ]] && (($(wc -l <part-1/results.csv) >= 2)) && break
  sleep 0.05
done
kill -KILL "$shard"
wait "$shard" 2>/dev/null || true
expect 1 gaitctl campaign merge part-2 -o some >some.txt
grep -q '4 of 8 runs' some.txt || fail "with a shard missing: $(cat some.txt)"
expect 0 "${first[@]}" --resume >first.txt
expect 0 "${merge[@]}" >merged.txt
same whole

if ! start_cluster "$scratch/cluster"; then
  echo "skipped: no cluster starts on this machine, for what its programs say above; shards were tested"
  exit 77
fi
"${submit[@]}" >lost.txt 2>&1 &
campaign=$!
for _ in {1..300}; do # until a shard is at work there
  task=$(squeue --noheader --states=R --format='%N %K' 2>/dev/null | awk '$1 == "n2" { print $2 }')
  [[ -n $task && -f out/shards/$(printf %04d "$task")/origin.json ]] && break
  sleep 0.05
done
kill_node n2
code=0
wait "$campaign" || code=$?
((code == 1)) || fail "ended with $code though a node died: $(cat lost.txt)"
grep -q 'of 4 shards did not finish.*--resume' lost.txt || fail "$(cat lost.txt)"
grep -q 'shards wait, [12] run' lost.txt || fail "no queue: $(cat lost.txt)"
expect 0 "${resume[@]}" >resumed.txt 2>&1
same out
