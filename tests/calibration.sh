# A robot whose drives bend and whose feet hang in their sensors walks with the calibration of its kind
# (these walks fall without it), and its log holds that.
source "$(dirname "$0")/common.sh"
cd "$scratch"
real=(--set actuators.model=hydraulic --set sensors.noise=lab --set seed=2)

# run SCENARIO NAME ARGUMENTS...: every bound of the scenario is of other drives, so only the steps count.
run() {
  local scenario=$1 name=$2
  shift 2
  gaitctl run "$scenario" --log "$name.mcap" "${real[@]}" "$@" >"$name.txt" 2>&1 || true
  grep -q '^verdict' "$name.txt" || { cat "$name.txt"; fail "$scenario: no verdict"; }
}
for scenario in flat-0.35 straight-0.35; do
  run "$scenario" with --set calibration=hydraulic
  grep -Eq 'FAIL +(no_fall|steps_taken|played_to_the_end|toe_off)' with.txt &&
    { cat with.txt; fail "$scenario with its calibration"; }
  echo "$scenario: $(grep -E '^ +icp_error_rms ' with.txt | tail -n 1)"
done

# From the log alone: the calibration is in it.
gaitctl log replay with.mcap >replay.txt 2>&1 || { cat replay.txt; fail "the replay of a calibrated robot"; }

gaitctl run stand --set calibration=hydraulics >unknown.txt 2>&1 && fail "an unknown calibration was taken"
grep -q "'hydraulic'" unknown.txt || { cat unknown.txt; fail "no advice"; }
