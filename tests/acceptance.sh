#!/usr/bin/env bash
# The long measurements behind the figures of the documentation, by ./run-tests --acceptance. What was
# interrupted goes on where it was; results are kept in build/acceptance, and each row of
# docs/acceptance.md names the commit that it was measured on.
#   tests/acceptance.sh [NAME...]     all of them unless given
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export PATH=$PWD/build/release/bin:$PATH
campaigns=(gate gauntlet terrain estimators model-errors walks footsteps footsteps-apart sessions parameters
  drive drive-parameters drive-pushed goto partial)
names=("${campaigns[@]}" mutations sanitizers slurm soak)
chosen=("$@")
((${#chosen[@]})) || chosen=("${names[@]}")
for name in "${chosen[@]}"; do
  [[ " ${names[*]} " == *" $name "* ]] || {
    echo "acceptance: there is no '$name'; known: ${names[*]}" >&2
    exit 2
  }
done

# Its own rows in docs/acceptance.md are no change of what is measured.
commit=$(git describe --always 2>/dev/null || echo unknown)
git diff --quiet HEAD -- . ':!docs/acceptance.md' 2>/dev/null || commit+=-dirty
# row NAME RESULT: into the table, in place of the one before.
row() {
  local table=docs/acceptance.md line
  line="| $1 | $2 | $commit | $(date -u +%F) |"
  if grep -q "^| $1 |" "$table"; then
    awk -v name="| $1 |" -v line="$line" 'index($0, name) == 1 { print line; next } { print }' \
      "$table" >"$table.new" && mv "$table.new" "$table"
  else
    printf '%s\n' "$line" >>"$table"
  fi
}

failed=()
for name in "${chosen[@]}"; do
  out=build/acceptance/$name
  mkdir -p "$out"
  result=0
  case $name in
    mutations) tests/mutations.sh >"$out/output.txt" 2>&1 || result=$? ;;
    sanitizers) tests/sanitizers.sh >"$out/output.txt" 2>&1 || result=$? ;;
    slurm) tests/slurm_kill.sh >"$out/output.txt" 2>&1 || result=$? ;;
    soak) tests/soak.sh 0.75 >"$out/output.txt" 2>&1 || result=$? ;;
    *) gaitctl campaign "sim/campaigns/$name.yaml" -o "$out/$commit" || result=$? ;;
  esac
  ((result == 0)) || failed+=("$name")
  text=$( ((result == 0)) && echo passed || echo "failed ($result)")
  results=$out/$commit/results.csv
  [[ -f $results ]] && text+=", $(($(wc -l <"$results") - 1)) runs"
  row "$name" "$text"
done
for name in "${failed[@]}"; do echo "FAILED: $name" >&2; done
((${#failed[@]} == 0))
