#!/usr/bin/env bash
# Unit tests and six short walks under AddressSanitizer with UndefinedBehaviorSanitizer, and under
# ThreadSanitizer. Each preset is built in full first, which takes a while.
#   tests/sanitizers.sh [asan] [tsan]     both unless given
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
presets=("$@")
((${#presets[@]})) || presets=(asan tsan)
export ASAN_OPTIONS=detect_stack_use_after_return=1:check_initialization_order=1
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
export TSAN_OPTIONS=halt_on_error=1:second_deadlock_stack=1:suppressions=$PWD/tests/tsan_suppressions.txt
walks=(stop flat-0.35 straight-0.35 turn push-straight-forward stairs-alternating)
failed=()

# walk PRESET SCENARIO: in lockstep, and its log read again.
walk() {
  local bin=build/$1/bin log=build/$1/sanitizer-$2.mcap
  "$bin/gaitctl" run "$2" --log "$log" && "$bin/gaitctl" log replay "$log" >/dev/null
}

for preset in "${presets[@]}"; do
  cmake --preset "$preset" -DGAITD_BUILD_BENCHMARKS=OFF
  cmake --build --preset "$preset" --parallel "$(nproc)"
  ctest --test-dir "build/$preset" -LE 'scenario|system|fuzz' --output-on-failure ||
    failed+=("$preset: unit tests")
  for scenario in "${walks[@]}"; do
    walk "$preset" "$scenario" || failed+=("$preset: $scenario")
  done
done
for what in "${failed[@]}"; do echo "FAILED: $what" >&2; done
((${#failed[@]} == 0))
