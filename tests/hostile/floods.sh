# Clients that flood gaitd in every way that was thought of: an e-stop of somebody else is acted on at once.
source "$(dirname "$0")/../common.sh"
python3 "$(dirname "$0")/floods.py" "$scratch" || fail "see above"
