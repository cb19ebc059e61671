# Robots of other sizes and proportions walk with the same parameters: with straight and with bent
# legs, both estimators, noise and drive dynamics. Steps go with the size, times with its root.
source "$(dirname "$0")/common.sh"

# robot NAME LENGTH SWING TRANSFER ARGUMENTS: a robot and its scenarios.
robot() {
  local name=$1 length=$2 swing=$3 transfer=$4
  shift 4
  python3 "$GAITD_SOURCE/tests/other_robot.py" "$GAITD_SOURCE/robots/atlas" "$scratch/$name" "$@"
  for mode in walk-bent walk-straight; do
    for estimator in kinematic_inertial invariant_ekf; do
      cat >"$scratch/$name-$mode-$estimator.yaml" <<SCENARIO
schema: gaitd.scenario/1
name: $name-$mode-$estimator
robot: $scratch/$name/robot.yaml
duration: 12
seed: 1
mode: $mode
set: {state_estimator.variant: $estimator}
sensors: {noise: nominal}
actuators: {model: nominal}
commands:
  - {at: 1.0, walk: {steps: 6, length: $length, swing: $swing, transfer: $transfer}}
expect:
  no_fall: true
  steps_taken: 6
  icp_error_rms_max: 0.03
  foot_slip_max: 0.01
  stance_knee_mean_max: $([[ $mode == walk-straight ]] && echo 0.4 || echo 1.6)
SCENARIO
    done
  done
}

robot small 0.21 0.465 0.194 --size 0.6
robot large 0.42 0.657 0.274 --size 1.2
robot long 0.35 0.6 0.25 --legs 1.12 --feet 0.85 --leg-mass 1.3
robot top-heavy 0.35 0.6 0.25 --feet 0.8 --torso-mass 1.2

# Standing and pushed forward, the small one steps by itself: 0.6^3 of the 700 N of
# push-bent-step-forward, for 0.2 s times the root of 0.6.
cat >"$scratch/small-pushed.yaml" <<SCENARIO
schema: gaitd.scenario/1
name: small-pushed
robot: $scratch/small/robot.yaml
duration: 10
seed: 3
mode: walk-bent
sensors: {noise: nominal}
actuators: {model: nominal}
disturbances:
  - {link: utorso, point: [0, 0, 0.18], force: [151, 0, 0], duration: 0.155, when: {time: 2.0}}
expect:
  no_fall: true
  checks: [{signal: gait/step_index, stat: max, min: 1}]
SCENARIO

# Without noise too: a foot sensor that says zero until a late touchdown is not a dead one.
sed 's/noise: nominal/noise: none/; s/model: nominal/model: ideal/' \
  "$scratch/small-walk-straight-kinematic_inertial.yaml" >"$scratch/small-ideal.yaml"

# Two at a time, as tests run beside each other.
ls "$scratch"/*.yaml | xargs -P2 -I{} bash -c 'gaitctl run {} -v --log {}.glog >{}.txt 2>&1 || touch {}.failed'
for failed in "$scratch"/*.failed; do
  if [[ -e $failed ]]; then fail "$(cat "${failed%.failed}.txt")"; fi
done
grep -H 'icp_error_rms  ' "$scratch"/*.txt | sed "s|$scratch/||"
