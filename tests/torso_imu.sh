# An IMU in the torso, behind the joints of the waist, as most humanoids have it: the robot stands, and
# walks as well as with one in the pelvis.
source "$(dirname "$0")/common.sh"
cd "$scratch"
cp -r "$GAITD_SOURCE/robots/atlas" robot
sed -i 's/{name: pelvis_imu, link: pelvis, xyz: \[0, 0, 0\]/{name: torso_imu, link: utorso, xyz: [-0.05, 0.02, 0.25]/' \
  robot/robot.yaml
grep -q 'link: utorso, xyz' robot/robot.yaml || fail "the robot has no IMU to be moved"
for estimator in kinematic_inertial invariant_ekf; do
  for scenario in stand flat-0.35 straight-0.35 turn sideways backward; do
    sed 's|^robot: .*|robot: robot/robot.yaml|' "$GAITD_SOURCE/sim/scenarios/$scenario.yaml" >"$scenario.yaml"
    gaitctl run "$scenario.yaml" -v --log walk.mcap --set "state_estimator.variant=$estimator" \
      >run.txt 2>&1 || {
      cat run.txt
      fail "$scenario with $estimator"
    }
    echo "$estimator $scenario: $(grep -E ' icp_error_rms ' run.txt | tail -n 1)"
  done
done
