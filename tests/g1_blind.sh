# The G1 crosses a field that it is at the limit of in most of 22 runs.
source "$(dirname "$0")/common.sh"
cd "$scratch"

expect 0 gaitctl campaign "$GAITD_SOURCE/sim/campaigns/g1-blind.yaml" -o blind
