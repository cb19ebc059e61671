# The contract is the same memory for every compiler and language that a plugin may be written with:
# each header alone and the table of the layout, with gcc and clang, as C and as C++.
# Usage: compile_abi.sh INTERFACES_FOLDER
set -euo pipefail
interfaces=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

failed=0
compiled=0
compile() {  # COMPILER STANDARD LANGUAGE SOURCE
  if "$1" -std="$2" -x "$3" -fsyntax-only -Wall -Wextra -Wconversion -pedantic -Werror \
    -I"$interfaces/include" -I"$interfaces/test" "$4" >"$scratch/out" 2>&1; then
    compiled=$((compiled + 1))
    return
  fi
  printf '%s -std=%s of %s:\n' "$1" "$2" "$(basename "$4")" >&2
  head -n 20 "$scratch/out" >&2
  failed=$((failed + 1))
}

for header in backend control gait model motions plugin state types; do
  printf '#include "gaitd/abi/%s.h"\n' "$header" >"$scratch/alone_$header.c"
  # Nothing of it may be left out of the table.
  while read -r name; do
    grep -q "X($name, [0-9]" "$interfaces/test/abi_layout.h" && continue
    echo "$name of $header.h is not in abi_layout.h; run update_abi_layout.py" >&2
    failed=$((failed + 1))
  done < <(sed -nE 's/^typedef struct (\w+) \{$/\1/p' "$interfaces/include/gaitd/abi/$header.h")
done
sources=("$scratch"/alone_*.c "$interfaces/test/abi_layout_static.c")

for compiler in gcc clang; do
  cxx=${compiler/gcc/g++}
  cxx=${cxx/clang/clang++}
  for needed in "$compiler" "$cxx"; do
    command -v "$needed" >/dev/null && continue
    echo "no $needed; install the packages of cmake/debian-packages.txt" >&2
    exit 1
  done
  for source in "${sources[@]}"; do
    for standard in c99 c11 c17; do compile "$compiler" "$standard" c "$source"; done
    for standard in c++11 c++17 c++20; do compile "$cxx" "$standard" c++ "$source"; done
  done
done

# The assertions assert: a field in front of all others is found out.
mkdir -p "$scratch/include/gaitd"
cp -r "$interfaces/include/gaitd/abi" "$scratch/include/gaitd/abi"
sed -i 's/^typedef struct GaitdToeOff {$/&\n  double late;/' "$scratch/include/gaitd/abi/gait.h"
if gcc -std=c99 -fsyntax-only -I"$scratch/include" -I"$interfaces/test" \
  "$interfaces/test/abi_layout_static.c" >"$scratch/out" 2>&1; then
  echo "a moved field went unnoticed" >&2
  failed=$((failed + 1))
fi

echo "$compiled of $((compiled + failed)) compilations went well"
((failed == 0 && compiled >= 108))
