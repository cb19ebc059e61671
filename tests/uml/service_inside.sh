# As a unit under systemd inside User-Mode Linux; /result is the folder of the test outside.
scratch=/result
source /result/inside.sh
cd /tmp
export PATH=/usr/sbin:/usr/bin:/sbin:/bin
# say TEXT: with the s since this script began.
say() { echo "$SECONDS s: $1"; }
# Motors that switched themselves off need a while until their errors are cleared.
arm() {
  wait_status 120 '*"healthy":true*'
  arm_robot &
  wait_state readying 120
}
say "systemd is up after $(cut -d. -f1 /proc/uptime) s"

# wait_for COMMAND SECONDS
wait_for() {
  local end=$((SECONDS + $2))
  until eval "$1"; do
    ((SECONDS < end)) || fail "after $2 s not: $1
$(gaitctl status 2>&1)
$(systemctl status gaitd --no-pager 2>&1 | tail -n 20)"
    sleep 0.2
  done
}
show() { systemctl show -P "$1" gaitd; }
restarts() { show NRestarts; }

apply_package() { dpkg --no-triggers --force-unsafe-io "$@" >/dev/null 2>/result/dpkg.txt; }
apply_package -i /result/gaitd.deb || fail "the package does not install: $(cat /result/dpkg.txt)"
say "gaitd is installed"
apply_package -i /result/gaitd-dev.deb || fail "gaitd-dev does not install: $(cat /result/dpkg.txt)"
apply_package -r gaitd-dev || fail "gaitd-dev is not removed: $(cat /result/dpkg.txt)"
[[ $(show ActiveState) == inactive ]] || fail "a package must not start a robot"
getent passwd gaitd >/dev/null || fail "no user gaitd"
messages=$(systemd-analyze verify --man=no gaitd.service 2>&1)
[[ -z $messages ]] || fail "systemd-analyze verify: $messages"

say "gaitd-dev installed and removed, the unit verified"

# A robot on three classic buses, so far above the ground that it does not fall over. Real time means
# little in here: long patience, and a watchdog that a machine under load does not set off.
can_links 3 16
install -m 644 /result/faulty.so /usr/lib/gaitd/
gaitd-fake-robot --can can-classic.yaml --period 0.01 --stall-time 6 --patience 30 \
  --world '{"terrain": {"ground_z": 0.0}, "start": {"z": 10000.0}}' \
  --report /result/robot.json >/result/robot.txt 2>&1 &
robot=$!
wait_for 'grep -q ready /result/robot.txt' 60
cat >/etc/gaitd/gaitd.yaml <<'CONFIG'
schema: gaitd.config/1
backend: socketcan
can: can-classic.yaml
period: 0.01
clock: realtime
socketcan: {lockstep_timeout: 30}
safety: {ready_duration: 60, sensor_timeout: 1}
state_estimator: {variant: /usr/lib/gaitd/faulty.so}
log: {enabled: false}
# mine
CONFIG
cat >/usr/lib/gaitd/sandbox.py <<'PYTHON'
import socket, sys
try:
    socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    sys.exit('AF_INET is allowed')
except OSError as error:
    print('AF_INET:', error)
try:
    open('/etc/gaitd/gaitd.yaml', 'a')
    sys.exit('/etc is writable')
except OSError as error:
    print('/etc:', error)
s = socket.socket(socket.PF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
s.bind(('can0',))
PYTHON
mkdir -p /etc/systemd/system/gaitd.service.d
# What runs before gaitd runs in the same sandbox.
cat >/etc/systemd/system/gaitd.service.d/test.conf <<'UNIT'
[Service]
ExecStartPre=/usr/bin/python3 /usr/lib/gaitd/sandbox.py
WatchdogSec=15
RestartSec=9
TimeoutStartSec=600
TimeoutStopSec=120
UNIT
systemctl daemon-reload
systemctl start gaitd || fail "the service does not start:
$(systemctl status gaitd --no-pager; journalctl -u gaitd -n 30 --no-pager 2>&1)"
ask_status
[[ $status == *'"state":"disarmed"'* ]] || fail "expected the service to come up disarmed: $status"
wait_for '[[ $(show StatusText) == disarmed* ]]' 60
# On a machine under load it may have been started again since.
control_thread() { ps -L -o cls=,rtprio= -p "$(show MainPID)" | grep 'FF *80' >/dev/null; }
wait_for control_thread 60
pid=$(show MainPID)
[[ $(stat -c %U "/proc/$pid") == gaitd ]] || fail "the service runs as $(stat -c %U "/proc/$pid")"
(($(awk '/^VmLck/ { print $2 }' "/proc/$pid/status") > 10000)) || fail "memory is not locked"
for socket in gaitd gaitd-observe gaitd-admin; do
  [[ $(stat -c '%a %G' "/run/gaitd/$socket.sock") == "660 $socket" ]] ||
    fail "$socket.sock is $(stat -c '%a %G' "/run/gaitd/$socket.sock")"
done
say "ready, disarmed, as user gaitd with SCHED_FIFO 80 and locked memory; no network, /etc read-only"

# With torque on the motors in lockstep with the robot, whatever the speed of this machine.
sed -i 's/^clock:.*/clock: lockstep/' /etc/gaitd/gaitd.yaml
systemctl restart gaitd || true # tries again where the motors answer too late
wait_state disarmed 300

# Crash, with torque on the motors: they switch off by themselves, gaitd comes back disarmed.
arm
kill -SEGV "$(show MainPID)"
# More than one restart where a loaded machine makes the motors answer too late.
wait_for '(($(restarts) >= 1))' 300
wait_state disarmed 300
say "crash: restarted into disarmed"

# An end that looks like a good one, as a library that calls exit() makes it.
before=$(restarts)
kill -TERM "$(show MainPID)"
wait_for '(($(restarts) > before))' 300
wait_state disarmed 300
say "end with exit code 0: restarted into disarmed"

# The control thread hangs with torque on the motors, the others go on: the watchdog.
arm
before=$(restarts)
gaitctl param set state_estimator.fault 8 >/dev/null 2>&1 &
wait_for '[[ $(show Result) == watchdog ]]' 300
wait_for '(($(restarts) > before))' 300
wait_state disarmed 300
say "hang: killed by the watchdog, restarted into disarmed"

# Stop, with torque on the motors: they are switched off, not left to their timeout.
arm
systemctl stop gaitd
[[ $(show Result) == success ]] || fail "stop: $(show Result)"
stop_robot
say "stop: motors off by command; after crash and hang they had switched off by themselves"

# Upgrade: what the operator wrote stays.
apply_package --force-confold -i /result/next.deb || fail "no upgrade: $(cat /result/dpkg.txt)"
grep -q '^# mine' /etc/gaitd/gaitd.yaml || fail "the upgrade lost the configuration"
[[ $(dpkg-query -W -f '${Version}' gaitd) == 99.0-1 ]] || fail "not upgraded"
rm /usr/lib/gaitd/faulty.so /usr/lib/gaitd/sandbox.py
apply_package -r gaitd || fail "no removal: $(cat /result/dpkg.txt)"
[[ ! -e /usr/bin/gaitd && -f /etc/gaitd/gaitd.yaml ]] ||
  fail "removal: expected the programs gone and the configuration kept"
apply_package -P gaitd || fail "no purge: $(cat /result/dpkg.txt)"
[[ ! -e /etc/gaitd/gaitd.yaml ]] || fail "purged, but the configuration is there"
say "upgraded with kept configuration, removed, purged"
echo "the service is in order"
