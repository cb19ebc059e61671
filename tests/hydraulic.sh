# Every scenario with hydraulic drives and the sensors of a laboratory, on the robot that `calibrate` has
# measured, with the estimator that finds it harder. The gate asks for all of them on three robots with both
# estimators; here, where a run of a difficult scenario is decided by millimetres, the share that holds may
# not sink: it is 0.875, and was 0.91 when the robot knew the offsets of its sensors of the very day.
source "$(dirname "$0")/common.sh"
cd "$scratch"

robot=$GAITD_BUILD/tests/robot-2.yaml
[[ -f $robot ]] || fail "no $robot: the test calibrate makes it"
sed -e 's/^seeds:.*/seeds: [2]/' -e '/^calibrate:/d' \
  -e "s#calibration: hydraulic,#calibration: $robot,#" \
  "$GAITD_SOURCE/sim/campaigns/gate.yaml" >gate.yaml
grep -q "calibration: $robot," gate.yaml || fail "gate.yaml has no calibration of hydraulic drives"
echo 'success_min: [{where: {plant: hydraulic}, rate: 0.84}]' >>gate.yaml
gaitctl campaign gate.yaml -o out --set plant=hydraulic --set state_estimator.variant=kinematic_inertial >campaign.txt 2>&1 && result=0 || result=$?
cat out/summary.txt
((result == 0)) || { tail -40 campaign.txt; fail "campaign: $result"; }
(($(wc -l <out/results.csv) > 60)) || fail "only $(wc -l <out/results.csv) runs"
