#!/usr/bin/env bash
# Can the tests fail? Damages the controller in one place at a time and looks which tests notice: its unit
# tests, and walks (behaviour). Every damage has to fail at least one of them.
#   tests/mutations.sh [--unit | --scenarios] [NAME...]    all damages unless named; --unit, --scenarios: the
#                                                          others are not asked, and do not count
#   tests/mutations.sh --check                             only that each expression still finds what it damages
# Works on a copy in build/mutations that is kept, so that only what changed since is built again; with
# ccache not even that. Of the scenarios those come first in which the damage should show, and the first
# that fails ends the search; where none of them does, all others are played.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
copy=$PWD/build/mutations/source

icp_feedback=walking/src/icp_feedback.cc
objectives=walking/src/objectives.cc
feet=walking/src/objectives_feet.cc
qp=plugins/whole_body_controller/inverse_dynamics/inverse_dynamics_qp.cc
toe_off=plugins/toe_off/icp_criteria/icp_criteria.cc
# NAME | tests of scenarios, the likely ones first | FILE | expression of perl, over the whole file; several
# FILE|EXPRESSION pairs may follow.
damages=(
  "icp_gain_sign|scenario.push-bent-forward scenario.flat-0.35|$icp_feedback|s/\(1\.0 \+ p_\[Feedback::kGain(\w+)\] \/ omega\)/(1.0 - p_[Feedback::kGain\$1] \/ omega)/g"
  "no_delay_prediction|invariant_ekf.flat-0.35 nominal.straight-0.35|$icp_feedback|s/for \(int ago = ticks; ago >= 1; --ago\)/for (int ago = 0; ago >= 1; --ago)/"
  "height_commanded|scenario.straight-0.35 scenario.straight-0.50|$objectives|s/out\.momentum_mask =\n/out.momentum_mask = 0b100000u |\n/"
  "no_privileged_legs|scenario.straight-0.35|$objectives|s/out\.privileged_weight\[joint\] = weight;/out.privileged_weight[joint] = 0.0;/"
  "toe_off_always|scenario.push-straight-rolling|$toe_off|s/state_\.time_satisfied > kHoldTime \? 1 : 0/1/"
  "toe_off_never|scenario.straight-0.35|$toe_off|s/state_\.time_satisfied > kHoldTime \? 1 : 0/0/"
  "no_late_touchdown|scenario.blind-0.08 scenario.blind-field-1|walking/src/gait_machine.cc|s/state_\.late_contact = over && !landed \? 1 : 0;/state_.late_contact = 0;/|walking/src/swing_trajectory.cc|s/Hurry hurry\(double late, double acceleration, double most\) \{/Hurry hurry(double late, double acceleration, double most) {\n  if (late < 1e9) return {0.0, 0.0};/"
  "no_torque_limits|scenario.push-bent-outward scenario.stairs-alternating|$qp|s/const double effort = limits\.torque_scale \* joint\.effort_limit;/const double effort = 1e6;/"
  "no_contact_ramp|scenario.straight-0.35 scenario.flat-0.35|$feet|s/(ObjectiveBuilder::load_share\(int side, const GaitdGaitState& gait\) const \{)/\$1\n  if (side < 2 || gait.phase < 0) return 1.0;/"
  "step_shift_mirrored|scenario.push-bent-outward scenario.push-bent-sideways|plugins/step_adjuster/step_plan/step_plan.cc|s/Eigen::Vector3d\(shift_\.x\(\), shift_\.y\(\), 0\.0\)/Eigen::Vector3d(shift_.x(), -shift_.y(), 0.0)/g"
  "friction_doubled|scenario.push-bent-slippery|$feet|s/c\.friction = parameters_\[Objective::kFriction\];/c.friction = 2.0 * parameters_[Objective::kFriction];/"
  "partial_footholds_unseen|scenario.partial-straight scenario.partial-bent|walking/src/foot_contact.cc|s/const bool tips = tipped && !returns;/const bool tips = false;/"
  "no_balance|scenario.estimators invariant_ekf.flat-0.35 nominal.straight-0.35|plugins/state_estimator/kinematic_inertial/kinematic_inertial_feet.cc|s/if \(total < kBalancedShare \* weight_\) return;/return;/|plugins/state_estimator/invariant_ekf/invariant_ekf.cc|s/ {4}observe_balance\(in, out\);\n//"
  "swing_apex_halved|scenario.blind-0.06 scenario.cinder-blocks|walking/src/swing_trajectory.cc|s/\+ to\.swing_height;/+ 0.5 * to.swing_height;/"
)

# damage "FILE|EXPRESSION|...": of the current folder; fails if an expression finds nothing.
damage() {
  local rest=$1 file expression next
  while [[ -n $rest ]]; do
    file=${rest%%|*} rest=${rest#*|}
    # An expression may hold a "|" of its own: it ends where the next file begins.
    expression=${rest%%|walking/*} next=${rest%%|plugins/*}
    ((${#next} < ${#expression})) && expression=$next
    rest=${rest:${#expression}}
    rest=${rest#|}
    cp "$file" "$file.sound"
    perl -0pi -e "$expression" "$file"
    if cmp -s "$file" "$file.sound"; then
      rm "$file.sound"
      echo "$name: $file was not damaged; mend the expression" >&2
      return 1
    fi
    rm "$file.sound"
  done
}

unit=1 behaviour=1
case ${1:-} in
  --check)
    sound=$PWD scratch=$(mktemp -d)
    trap 'rm -rf "$scratch"' EXIT
    cd "$scratch"
    result=0
    for line in "${damages[@]}"; do
      name=${line%%|*} rest=${line#*|}
      rm -rf walking plugins && cp -r "$sound/walking" "$sound/plugins" .
      damage "${rest#*|}" || result=1
    done
    exit $result
    ;;
  --unit) behaviour='' && shift ;;
  --scenarios) unit='' && shift ;;
esac
chosen=("$@")
for name in "${chosen[@]}"; do
  printf '%s\n' "${damages[@]}" | grep -q "^$name|" || { echo "mutations: there is no '$name'" >&2; exit 2; }
done

# The copy, without touching what has not changed.
mkdir -p "$copy"
git ls-files | while read -r file; do
  cmp -s "$file" "$copy/$file" || cp --parents "$file" "$copy"
done
[[ ! -d $copy/.git ]] || comm -13 <(git ls-files | sort) <(git -C "$copy" ls-files | sort) |
  while read -r file; do rm -f "$copy/$file"; done
cd "$copy"
[[ -d .git ]] || git init -q .
git add -A && { git diff --cached --quiet || git -c user.name=x -c user.email=x commit -qm original; }
launcher=()
if command -v ccache >/dev/null; then
  export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$(dirname "$copy")} CCACHE_NOHASHDIR=1
  # It keeps nothing that was compiled with a precompiled header.
  launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON)
fi
cmake --preset release -DGAITD_BUILD_BENCHMARKS=OFF "${launcher[@]}" >/dev/null

build() {
  cmake --build build/release --target programs walking_test plugins_test >build/build.txt 2>&1
}

# The first unit test of the controller that fails, and how many do; "" if none does.
failed_unit_tests() {
  local program failed=()
  for program in walking_test plugins_test; do
    mapfile -t -O "${#failed[@]}" failed < <(
      "build/release/tests/$program" --gtest_brief=1 2>&1 |
        sed -n 's/^\[  FAILED  \] \([A-Za-z]*[A-Za-z0-9_/]*\.[A-Za-z0-9_/]*\).*(.*/\1/p' | sort -u)
  done
  ((${#failed[@]} == 0)) || echo "${failed[0]}$( ((${#failed[@]} > 1)) && echo " and $((${#failed[@]} - 1)) more")"
}

# Of the tests of scenarios that ctest chooses by its arguments: one that fails, and what it expected; "" if none does.
failed_scenario() {
  ctest --test-dir build/release --parallel "${CTEST_PARALLEL_LEVEL:-$(nproc)}" --stop-on-failure --output-on-failure \
    -L scenario "$@" >build/scenarios.txt 2>&1 || true
  local test
  test=$(sed -n 's/^ *[0-9]*\/[0-9]* Test *#[0-9]*: \([^ ]*\) .*\*\*\*.*/\1/p' build/scenarios.txt | head -n 1)
  [[ -z $test ]] || echo "$test:$(sed -n 's/^  FAIL *//p' build/scenarios.txt | tr -s ' ' | head -n 3 | paste -sd';')"
}

survived=()
for line in "${damages[@]}"; do
  name=${line%%|*} rest=${line#*|}
  ((${#chosen[@]})) && [[ " ${chosen[*]} " != *" $name "* ]] && continue
  likely=${rest%%|*}
  damage "${rest#*|}" || exit 2
  build || { echo "$name: does not compile: $(grep -m1 error build/build.txt)" >&2; exit 2; }
  by_unit='' by_scenario=''
  [[ -z $unit ]] || by_unit=$(failed_unit_tests)
  if [[ -n $behaviour ]]; then
    for test in $likely; do
      by_scenario=$(failed_scenario -R "^${test//./\\.}\$")
      [[ -z $by_scenario ]] || break
    done
    [[ -n $by_scenario || -n $by_unit ]] || by_scenario=$(failed_scenario)
  fi
  printf '%s\n  unit tests  %s\n  behaviour   %s\n' "$name" "${by_unit:-none}" "${by_scenario:-none}"
  [[ -n $by_unit$by_scenario ]] || survived+=("$name")
  git checkout -q -- walking plugins
done
((${#survived[@]} == 0)) || { echo "SURVIVED: ${survived[*]}"; exit 1; }
