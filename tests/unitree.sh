# gaitd over Unitree's DDS interface, with the fake G1 on the loopback: in lock step it stands and walks, and
# every fault ends in what docs/unitree.md says.
source "$(dirname "$0")/common.sh"
cd "$scratch"
[[ -x $GAITD_BUILD/bin/gaitd-fake-g1 ]] || { echo "skipped: built without CycloneDDS (cyclonedds-dev)"; exit 77; }
unset CYCLONEDDS_URI
domain=$((40 + $$ % 40))  # of this test alone, and of those of its runs that are beside each other
robot=

clean_up_robot() {
  kill -KILL $robot 2>/dev/null || true
  clean_up
}
trap clean_up_robot EXIT

# start_robot NAME ARGUMENTS...: the fake G1, which leaves NAME.json when it ends.
start_robot() {
  local name=$1
  shift
  gaitd-fake-g1 --lockstep --patience 20 --domain "$domain" --report "$name.json" "$@" >robot.txt 2>&1 &
  robot=$!
  wait_until grep -q ready robot.txt || fail "the fake robot does not start: $(cat robot.txt)"
}

stop_robot() {
  kill -TERM "$robot"
  wait "$robot" || fail "the fake robot ended with $?: $(cat robot.txt)"
  robot=
}

start_gaitd() {
  start_daemon --robot g1 --backend unitree_dds --clock lockstep --set unitree_dds.interface=lo \
    --set unitree_dds.domain="$domain" --set unitree_dds.listen=0.2 --set unitree_dds.lockstep_timeout=20 \
    --set unitree_dds.damp_time=0.5 --set safety.ready_duration=0.5 --set log.enabled=false "$@"
}

arm() {
  local answer
  for _ in {1..100}; do
    answer=$(gaitctl arm 2>&1) && return
    [[ $answer == *"the robot is in fault"* ]] && return  # that came while it got ready
    [[ $answer == *"estimate yet"* || $answer == *"is silent"* ]] || break  # before its first ticks
    sleep 0.1
  done
  fail "not armed: $answer; $(gaitctl status)"
}

# expect_report NAME EXPRESSION...: of Python, about r.
expect_report() {
  local name=$1
  shift
  python3 - "$name.json" "$@" <<'PYTHON' || fail "$name: $(cat "$name.json")"
import json, sys
r = json.load(open(sys.argv[1]))
wrong = [text for text in sys.argv[2:] if not eval(text)]
print("\n".join(wrong))
sys.exit(1 if wrong else 0)
PYTHON
}

# It stands and walks.
start_robot walk
start_gaitd
wait_for state disarmed 20
arm
wait_for state standing 60
gaitctl mode walk-bent >/dev/null
gaitctl walk --steps 12 --length 0.15 >/dev/null
wait_for state walking 20
wait_for state standing 120
stop_daemon
sleep 0.7
stop_robot
expect_report walk "r['pelvis'][0] > 1.2" "r['refused']['crc'] == 0" "r['refused']['machine'] == 0" \
  "r['unanswered'] <= 1" "r['motors'] == {'driven': 0, 'damped': 29}"
echo "walked $(python3 -c "import json; r = json.load(open('walk.json')); print(r['pelvis'], r['cycles'])")"

# condition FAULT TEXT ARGUMENTS OF THE FAKE ROBOT...: while it goes to its posture something goes wrong.
number=0
condition() {
  local fault=$1 text=$2
  shift 2
  number=$((number + 1))
  start_robot "condition$number" "$@"
  start_gaitd --set safety.ready_duration=60 --set unitree_dds.lockstep_timeout="${patience:-20}"
  arm
  wait_until has_fault "$fault" || true
  [[ $(field faults) == "$fault" ]] || fail "$*: expected the fault $fault, got '$(field faults)', $(field health)"
  [[ $(gaitctl status) == *"$text"* ]] || fail "$*: expected '$text': $(gaitctl status)"
  stop_daemon
  stop_robot
  if [[ ${ignored-} ]]; then
    expect_report "condition$number" "r['refused']['machine'] > 0" "r['events'][-1].endswith('commands ceased')"
  else
    expect_report "condition$number" "r['fault_cycle'] > 0" \
      "0 <= r['damped_cycle'] - r['fault_cycle'] <= ${within:-3}" "r['motors']['driven'] == 0"
  fi
  echo "$*: $fault"
}

condition motor 'winding too hot' --fault error:left_knee_joint=512@0.2
within=110 condition motor 'it switched itself off' --fault off:left_ankle_roll_joint@0.2
condition estop '(L2+B)' --fault keys:L2+B@0.2
ignored=1 condition bus 'mode_machine changed from 5 to 6' --fault machine=6@0.2
condition bus 'the robot was started again' --fault restart@0.2
within=60 condition bus 'somebody else commands' --fault writer@0.2
patience=0.02 within=40 condition sensors '' --fault silent@0.2
within=30 condition sensors '' --fault stuck@0.2

# What it can do without.
start_robot harmless --fault torso@0.2 --fault lose=40@0.2 --fault battery=10@0.2
start_gaitd
arm
wait_for state standing 60
gaitctl disarm >/dev/null
answer=$(gaitctl arm 2>&1) && fail "armed with a charge of 10 %"
[[ $(gaitctl status) == *'charge 10 %'* ]] || fail "nothing of the charge: $(gaitctl status)"

stop_daemon
stop_robot

# gaitd is killed while it drives: its link damps, and ends.
start_robot killed
start_gaitd
arm
wait_for state standing 60
link=$(pgrep -f "gaitd-unitree-link lockstep .*\"domain\":$domain," || true)
[[ -n $link ]] || fail "no link"
kill -KILL "$daemon"
wait "$daemon" 2>/dev/null || true
daemon=
has_ended() { ! kill -0 "$1" 2>/dev/null; }
wait_until has_ended "$link" || fail "the link does not end"
stop_robot
expect_report killed "r['motors'] == {'driven': 0, 'damped': 29}" "r['cycles'] - r['last_driven_cycle'] > 20"
echo "killed: damped for $(python3 -c "import json; r = json.load(open('killed.json')); print(r['cycles'] - r['last_driven_cycle'])") periods"
