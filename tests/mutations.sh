#!/usr/bin/env bash
# Can the tests fail? Damages the controller in one place at a time and looks which test notices. Every
# damage has to fail at least one. Works on a copy in build/mutations; takes a build and some minutes for
# each damage.
#   tests/mutations.sh [--scenarios] [NAME...]     all damages unless named; --scenarios: unit tests do
#                                                  not count
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
copy=$PWD/build/mutations/source

icp_feedback=walking/src/icp_feedback.cc
objectives=walking/src/objectives.cc
qp=plugins/whole_body_controller/inverse_dynamics/inverse_dynamics_qp.cc
toe_off=plugins/toe_off/icp_criteria/icp_criteria.cc
# NAME | FILE | expression of perl, over the whole file; several FILE|EXPRESSION pairs may follow.
damages=(
  "icp_gain_sign|$icp_feedback|s/\(1\.0 \+ p_\[Feedback::kGain(\w+)\] \/ omega\)/(1.0 - p_[Feedback::kGain\$1] \/ omega)/g"
  "no_delay_prediction|$icp_feedback|s/for \(int ago = ticks; ago >= 1; --ago\)/for (int ago = 0; ago >= 1; --ago)/"
  "height_commanded|$objectives|s/out\.momentum_mask =\n/out.momentum_mask = 0b100000u |\n/"
  "no_privileged_legs|$objectives|s/out\.privileged_weight\[joint\] = r\.weight;/out.privileged_weight[joint] = 0.0;/"
  "toe_off_always|$toe_off|s/state_\.time_satisfied > p_\[P::kHoldTime\] \? 1 : 0/1/"
  "toe_off_never|$toe_off|s/state_\.time_satisfied > p_\[P::kHoldTime\] \? 1 : 0/0/"
  "no_late_touchdown|walking/src/gait_machine.cc|s/state_\.late_contact = over && !loaded \? 1 : 0;/state_.late_contact = 0;/|walking/src/swing_trajectory.cc|s/Hurry hurry\(double late, double acceleration, double most\) \{/Hurry hurry(double late, double acceleration, double most) {\n  if (late < 1e9) return {0.0, 0.0};/|$objectives|s/std::max\(0\.0, gait\.time_in_phase - gait\.phase_duration\)/0.0/"
  "no_torque_limits|$qp|s/const double effort = limits\.torque_scale \* joint\.effort_limit;/const double effort = 1e6;/"
  "no_contact_ramp|$objectives|s/if \(ramp <= 0\.0\) return 1\.0;/if (ramp <= 1e9) return 1.0;/"
  "step_shift_mirrored|plugins/step_adjuster/icp_qp/icp_qp.cc|s/Eigen::Vector3d\(shift_\.x\(\), shift_\.y\(\), 0\.0\)/Eigen::Vector3d(shift_.x(), -shift_.y(), 0.0)/g"
  "friction_doubled|$objectives|s/c\.friction = parameters_\[Objective::kFriction\];/c.friction = 2.0 * parameters_[Objective::kFriction];/"
  "no_balance|plugins/state_estimator/kinematic_inertial/kinematic_inertial.cc|s/if \(total < kBalancedShare \* weight_\) return;/return;/|plugins/state_estimator/invariant_ekf/invariant_ekf.cc|s/if \(time_since_start_ >= kJolt\) observe_balance\(in, out\);//"
  "swing_apex_halved|walking/src/swing_trajectory.cc|s/\+ to\.swing_height;/+ 0.5 * to.swing_height;/"
)

scenarios_only=
[[ ${1:-} == --scenarios ]] && { scenarios_only=1; shift; }
chosen=("$@")
rm -rf "$copy"
mkdir -p "$copy"
git ls-files -z | tar --null -T - -cf - | tar -xf - -C "$copy"
cd "$copy"
git init -q . && git add -A && git -c user.name=x -c user.email=x commit -qm original
cmake --preset release -DGAITD_BUILD_BENCHMARKS=OFF >/dev/null
cmake --build build/release >/dev/null

# Which tests fail, at most a few; "" if none does.
failures() {
  ctest --test-dir build/release --parallel "$(nproc)" --stop-on-failure "$@" 2>/dev/null |
    sed -n 's/^[0-9]*\/[0-9]* Test *#[0-9]*: \([^ ]*\) .*\(Failed\|Timeout\|Exception\).*/\1/p' |
    head -n 3 | paste -sd' '
}

survived=()
for damage in "${damages[@]}"; do
  name=${damage%%|*}
  ((${#chosen[@]})) && [[ " ${chosen[*]} " != *" $name "* ]] && continue
  rest=${damage#*|}
  while [[ -n $rest ]]; do
    file=${rest%%|*} rest=${rest#*|}
    # An expression may hold a "|" of its own: it ends where the next file begins.
    expression=${rest%%|walking/*} next=${rest%%|plugins/*}
    ((${#next} < ${#expression})) && expression=$next
    rest=${rest:${#expression}}
    rest=${rest#|}
    perl -0pi -e "$expression" "$file"
    git diff --quiet "$file" && { echo "$name: $file was not damaged; mend the expression" >&2; exit 2; }
  done
  caught=
  if cmake --build build/release >build.txt 2>&1; then
    [[ -n $scenarios_only ]] || caught=$(failures -LE 'scenario|system|fuzz')
    [[ -n $caught ]] || caught=$(failures -L 'nominal')
    [[ -n $caught ]] || caught=$(failures -L scenario)
  else
    echo "$name: does not compile: $(grep -m1 error build.txt)" >&2
    exit 2
  fi
  printf '%-22s %s\n' "$name" "${caught:-SURVIVED}"
  [[ -n $caught ]] || survived+=("$name")
  git checkout -q -- walking plugins
done
((${#survived[@]} == 0))
