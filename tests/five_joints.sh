# Legs of five joints, of which none rolls the foot: a made-up humanoid of 54 kg is described by
# `gaitctl robot init` alone and walks eight steps, bent and straight, with both estimators, noise and
# drive dynamics, and still stands ten seconds later.
source "$(dirname "$0")/common.sh"

python3 "$GAITD_SOURCE/tests/made_up_robots.py" "$scratch/urdf" narrow
expect 0 gaitctl robot init "$scratch/urdf/narrow/narrow.urdf" -o "$scratch/narrow" >"$scratch/init.txt"
grep -q 'no joint rolls' "$scratch/init.txt" && fail "narrow soles are not too wide: $(cat "$scratch/init.txt")"
for mode in walk-bent walk-straight; do
  for estimator in kinematic_inertial invariant_ekf; do
    for seed in 1 2 3; do
      cat >"$scratch/$mode-$estimator-$seed.yaml" <<SCENARIO
schema: gaitd.scenario/1
name: $mode-$estimator-$seed
robot: $scratch/narrow/robot.yaml
duration: 20
seed: $seed
mode: $mode
set: {state_estimator.variant: $estimator}
sensors: {noise: nominal}
actuators: {model: nominal}
commands:
  - {at: 1.0, walk: {steps: 8, length: 0.166, swing: 0.571, transfer: 0.245}}
expect:
  no_fall: true
  steps_taken: 8
  icp_error_rms_max: 0.05
  foot_slip_max: 0.01
  stance_knee_mean_max: $([[ $mode == walk-straight ]] && echo 0.35 || echo 1.0)
  final_pelvis: {x: 1.328, y: 0.0, tolerance: 0.35, yaw: 0.0, yaw_tolerance: 0.05}
SCENARIO
    done
  done
done
ls "$scratch"/walk-*.yaml | xargs -P2 -I{} bash -c 'gaitctl run {} -v --log {}.mcap >{}.txt 2>&1 || touch {}.failed'
for failed in "$scratch"/*.failed; do
  if [[ -e $failed ]]; then fail "$(cat "${failed%.failed}.txt")"; fi
done
grep -H 'icp_error_rms  ' "$scratch"/*.txt | sed "s|$scratch/||"

# Wide soles tip further: the doctor says so.
python3 "$GAITD_SOURCE/tests/made_up_robots.py" "$scratch/urdf" wide
expect 0 gaitctl robot init "$scratch/urdf/wide/wide.urdf" -o "$scratch/wide" >"$scratch/wide.txt"
grep -q 'no joint rolls the feet, and their soles are 102 mm wide' "$scratch/wide.txt" ||
  fail "nothing about soles that are too wide: $(cat "$scratch/wide.txt")"
