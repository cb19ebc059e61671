#!/usr/bin/env bash
# 500 runs in 20 shards on a Slurm of two nodes, one of which is killed in the middle; --resume plays what
# is missing, and the folder is that of one machine, to the byte. So three times, each killed later.
#   tests/slurm_kill.sh [TIMES]
export GAITD_SOURCE=$PWD GAITD_BUILD=${GAITD_BUILD:-$PWD/build/release}
source "$(dirname "$0")/common.sh"
source "$(dirname "$0")/slurm_cluster.sh"
why=$(why_no_cluster)
[[ -z $why ]] || fail "$why"
trap 'stop_cluster; clean_up' EXIT
cd "$scratch"

short_scenario 0.3 >short.yaml
cat >campaign.yaml <<'CAMPAIGN'
schema: gaitd.campaign/1
name: killed
scenarios: [short.yaml]
set: {state_estimator.variant: [kinematic_inertial, invariant_ekf]}
draw: {model_error.mass_scale.utorso: [0.9, 1.1]}
seeds: 250
CAMPAIGN
began=$SECONDS
expect 0 gaitctl campaign campaign.yaml -o local >local.txt 2>&1
echo "one machine: $((SECONDS - began)) s"

rows() { cat "$1"/shards/*/results.csv 2>/dev/null | grep -vc '^run,' || true; }

# at_work NODE FOLDER: it is in the middle of a shard.
at_work() {
  local task rows
  task=$(squeue --noheader --states=R --format='%N %K' | awk -v node="$1" '$1 == node { print $2 }')
  [[ -n $task ]] || return 1
  rows=$({ wc -l <"$2/shards/$(printf %04d "$task")/results.csv"; } 2>/dev/null) || return 1
  ((rows > 2 && rows < 20))
}

start_cluster "$scratch/cluster" || fail "no cluster"
for ((time = 1; time <= ${1:-3}; ++time)); do
  began=$SECONDS
  gaitctl campaign campaign.yaml --engine slurm --shards 20 -o "out$time" >lost.txt 2>&1 &
  campaign=$!
  until (($(rows "out$time") >= 100 * time)) && at_work n2 "out$time"; do
    kill -0 "$campaign" || fail "ended before the node: $(cat lost.txt)"
    sleep 0.1
  done
  kill_node n2
  code=0
  wait "$campaign" || code=$?
  ((code == 1)) || fail "ended with $code though a node died: $(cat lost.txt)"
  lost=$(grep -oE '[0-9]+ of 20 shards did not finish \([0-9,-]*\)' lost.txt) || fail "$(cat lost.txt)"
  rm -rf "$cluster/n2"
  mkdir "$cluster/n2"
  start_node n2
  expect 0 gaitctl campaign campaign.yaml --engine slurm --resume -o "out$time" >resumed.txt 2>&1
  for file in campaign.yaml results.csv summary.txt summary.json; do
    cmp "local/$file" "out$time/$file" || fail "$file is not that of one machine"
  done
  echo "time $time: $lost; the same bytes after $((SECONDS - began)) s"
done
(($(wc -l <local/results.csv) == 501)) || fail "not 500 runs"
