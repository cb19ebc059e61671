# gaitd-ros2 beside a simulated robot, looked at and commanded by a client on Fast DDS, the other vendor.
source "$(dirname "$0")/common.sh"
cd "$scratch"
look=$GAITD_BUILD/tests/ros2_fastdds_client
[[ -x $look ]] || { echo "skipped: Fast DDS is not installed (libfastrtps-dev)"; exit 77; }
unset CYCLONEDDS_URI ROS_DOMAIN_ID ROS_LOCALHOST_ONLY FASTRTPS_DEFAULT_PROFILES_FILE
export ROS_DOMAIN_ID=$((100 + $$ % 100))  # of this test alone; gaitd-ros2 takes it from here

for arguments in '--domain 233' '--namespace a//b' '--rate 0' '--auto-mode' 'surplus'; do
  read -ra words <<<"$arguments"
  expect 2 gaitd-ros2 "${words[@]}" 2>/dev/null
done

# What the user says of the network holds, unless it is to be left alone.
CYCLONEDDS_URI='<CycloneDDS><Nonsense>' expect 1 gaitd-ros2 --socket none >wrong.txt 2>&1
grep -q 'CYCLONEDDS_URI' wrong.txt || fail "a wrong CYCLONEDDS_URI: $(cat wrong.txt)"
loopback='<General><Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces></General>'
CYCLONEDDS_URI="<CycloneDDS><Domain>$loopback</Domain></CycloneDDS>" \
  expect 124 timeout 2 gaitd-ros2 --socket none --sim-time --best-effort --drive --stamped
CYCLONEDDS_URI='<CycloneDDS><Nonsense>' expect 124 timeout 2 gaitd-ros2 --socket none --localhost --no-e-stop

# It comes first and waits for gaitd.
gaitd-ros2 --localhost --namespace /robots/one --drive --auto-mode >ros2.txt 2>&1 &
bridge=$!
clean_up_bridge() {
  kill -KILL "$bridge" 2>/dev/null || true
  clean_up
}
trap clean_up_bridge EXIT
fail_with() { fail "$1: $(cat ros2.txt)"; }
start_daemon --set clock=realtime --set log.enabled=false
ticks() { awk '{ print $14 + $15 }' "/proc/$bridge/stat"; }
wait_until grep -q 'connected to gaitd' ros2.txt || fail_with "not connected"
begin=$(ticks) began=$EPOCHREALTIME
"$look" "$ROS_DOMAIN_ID" /robots/one || fail_with "the client on Fast DDS"
awk -v ticks=$(($(ticks) - begin)) -v hertz="$(getconf CLK_TCK)" -v began="$began" -v now="$EPOCHREALTIME" \
  'BEGIN { printf "gaitd-ros2 took %.1f %% of a processor\n", 100 * ticks / hertz / (now - began) }'
[[ $(field state) == fault && $(field faults) == *estop* ]] || fail "no estop: $(field state), $(field faults)"
grep -q 'e-stop: gaitd has taken it' ros2.txt || fail_with "the e-stop was not told"
(($(grep -c 'cmd_vel: a velocity was refused' ros2.txt) == 1)) || fail_with "the NaN was not told once"

# Nobody answers an e-stop, and then somebody does.
taken=$(grep -c 'e-stop: gaitd has taken it' ros2.txt)
kill -STOP "$daemon"
"$look" "$ROS_DOMAIN_ID" /robots/one silent || fail_with "an e-stop without an answer"
grep -q 'the robot may not have stopped: gaitd does not answer' ros2.txt || fail_with "the log does not tell of it"
kill -CONT "$daemon"
taken_again() { (($(grep -c 'e-stop: gaitd has taken it' ros2.txt) > taken)); }
wait_until taken_again || fail_with "the e-stop is not asked for until somebody answers"

# gaitd goes and comes back.
kill -KILL "$daemon"
wait "$daemon" 2>/dev/null || true
wait_until grep -q 'not connected' ros2.txt || fail_with "it does not say that gaitd has gone"
start_daemon --set clock=realtime --set log.enabled=false
is_back() { (($(grep -c 'connected to gaitd' ros2.txt) == 2)); }
wait_until is_back || fail_with "it does not come back"
code=0
kill -TERM "$bridge"
wait "$bridge" || code=$?
((code == 0)) || fail_with "gaitd-ros2 ended with $code on SIGTERM"
stop_daemon
