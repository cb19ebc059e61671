# A robot whose drives bend and whose feet hang in their sensors walks with the calibration of its kind
# (these walks fall without it), and its log holds that.
source "$(dirname "$0")/common.sh"
cd "$scratch"
real=(--set actuators.model=hydraulic --set sensors.noise=lab --set seed=2)

# The other bounds of the scenarios are of other drives.
for scenario in flat-0.35 straight-0.35; do
  gaitctl run "$scenario" -v --log with.mcap "${real[@]}" --set calibration=hydraulic >with.txt 2>&1 || true
  grep -qE "^$scenario: (PASS|FAIL)" with.txt || { cat with.txt; fail "$scenario: no verdict"; }
  grep -Eq 'FAIL +(no_fall|steps_taken|played_to_the_end|toe_off)' with.txt &&
    { cat with.txt; fail "$scenario with its calibration"; }
  echo "$scenario: $(grep -E '^ +icp_error_rms ' with.txt | tail -n 1)"
done

# From the log alone: the calibration is in it.
gaitctl log replay with.mcap >replay.txt 2>&1 || { cat replay.txt; fail "the replay of a calibrated robot"; }

gaitctl run stand --set calibration=hydraulics >unknown.txt 2>&1 && fail "an unknown calibration was taken"
grep -q "'hydraulic'" unknown.txt || { cat unknown.txt; fail "no advice"; }
