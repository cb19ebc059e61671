# Every plugin that gaitd ships passes the suite for plugin authors; what docs/plugins.md tells people
# to type works; the exit codes are the documented ones.
source "$(dirname "$0")/common.sh"
export GAITD_PLUGINS=$GAITD_BUILD/lib/gaitd/plugins

count=0
for plugin in "$GAITD_PLUGINS"/*/*.so; do
  gaitctl plugin check "$plugin" >"$scratch/report" || fail "$(cat "$scratch/report")"
  tail -n 1 "$scratch/report"
  if grep -q '^warning *\(binding\|sharing\|unload\)' "$scratch/report"; then
    fail "$(cat "$scratch/report")"
  fi
  count=$((count + 1))
done
((count >= 7)) || fail "only $count plugins in $GAITD_PLUGINS"

mapfile -t lines < <(commands_of docs/plugins.md)
((${#lines[@]} >= 2)) || fail "docs/plugins.md has only ${#lines[@]} lines of commands"
for line in "${lines[@]}"; do
  printf '$ %s\n' "$line"
  eval "$line" >"$scratch/out" || fail "'$line' ended with exit code $?: $(cat "$scratch/out")"
done
grep -q '"pass": true' "$scratch/out" || fail "the last command of docs/plugins.md prints no JSON"

printf 'no library' >"$scratch/text.so"
expect 1 gaitctl plugin check "$scratch/text.so" >"$scratch/report"
grep -q '^FAIL     file' "$scratch/report" || fail "$(cat "$scratch/report")"
expect 1 gaitctl plugin check "$scratch/none.so" >/dev/null
expect 1 gaitctl plugin check "$scratch/text.so" --json >"$scratch/json"
grep -q '"verdict": "fail"' "$scratch/json" || fail "$(cat "$scratch/json")"
expect 1 gaitctl plugin check "$scratch/text.so" --robot no-such-robot 2>/dev/null
expect 2 gaitctl plugin check 2>/dev/null
expect 2 gaitctl plugin check "$scratch/text.so" --timeout 0 2>/dev/null
