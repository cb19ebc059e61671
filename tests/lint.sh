# Style: clang-format over everything, clang-tidy over the sources that the last commit changed, tests left out: for six
# minutes, then it names what it did not get to.
#   GAITD_LINT_BASE     changes since this commit; by default the one before the last
#   GAITD_LINT_SECONDS  360 unless given
source "$(dirname "$0")/common.sh"
cd "$GAITD_SOURCE"
for tool in clang-format clang-tidy git; do
  command -v "$tool" >/dev/null || { echo "no $tool; install the packages of cmake/debian-packages.txt"; exit 77; }
done
git rev-parse --git-dir >/dev/null 2>&1 || { echo "no repository, so nothing says what was changed"; exit 77; }

mapfile -t all < <(git ls-files '*.cc' '*.h')
clang-format --dry-run --Werror "${all[@]}" 2>"$scratch/format.txt" ||
  fail "run clang-format -i on: $(sed -n 's/^\([^ :]*\):.* error: .*/\1/p' "$scratch/format.txt" | sort -u | tr '\n' ' ')"

# The options of each file by itself; the build compiles several at once (unity). What it generated is in its folder.
# clang does not know every option of gcc, and takes an unknown one for an error of the source.
cmake --preset release -B "$scratch/tidy" -DCMAKE_UNITY_BUILD=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >"$scratch/cmake.txt" ||
  fail "$(cat "$scratch/cmake.txt")"
sed "s# -fno-gnu-unique##; s#$scratch/tidy/#$GAITD_BUILD/#g" "$scratch/tidy/compile_commands.json" >"$scratch/compile_commands.json"

base=${GAITD_LINT_BASE:-HEAD~1}
git rev-parse -q --verify "$base" >/dev/null || base=HEAD
# Only what is compiled has options to be looked at with.
mapfile -t changed < <(git diff --name-only --diff-filter=d "$base" -- '*.cc' | while read -r file; do
  [[ $file != */test/* ]] && grep -q "\"file\": \".*/$file\"" "$scratch/compile_commands.json" && echo "$file"
done)
end=$((SECONDS + ${GAITD_LINT_SECONDS:-360}))
failed=()
for file in "${changed[@]}"; do
  if ((SECONDS >= end)); then
    echo "not looked at for want of time: $file"
    continue
  fi
  clang-tidy -p "$scratch" --quiet --header-filter='^$' --warnings-as-errors='*' "$file" >"$scratch/tidy.txt" 2>&1 && continue
  grep -A4 'error: ' "$scratch/tidy.txt" || cat "$scratch/tidy.txt"
  failed+=("$file")
done
((${#failed[@]} == 0)) || fail "clang-tidy: ${failed[*]}"
