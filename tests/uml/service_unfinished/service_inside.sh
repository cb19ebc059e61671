# As a unit under systemd inside User-Mode Linux; /result is the folder of the test outside.
scratch=/result
source /result/inside.sh
cd /tmp
export PATH=/usr/sbin:/usr/bin:/sbin:/bin

wait_for() {  # COMMAND SECONDS
  local end=$((SECONDS + $2))
  until eval "$1"; do
    ((SECONDS < end)) || fail "after $2 s not: $1
$(systemctl status gaitd --no-pager 2>&1 | tail -n 20)"
    sleep 0.2
  done
}
pid() { systemctl show -P MainPID gaitd; }
restarts() { systemctl show -P NRestarts gaitd; }
state() { gaitctl status 2>/dev/null | awk '$1 == "state" { print $2 }'; }

dpkg -i --no-triggers --force-unsafe-io /result/gaitd.deb >/dev/null || fail "the package does not install"
[[ $(systemctl is-active gaitd) == inactive ]] || fail "a package must not start a robot"
getent passwd gaitd >/dev/null || fail "no user gaitd"
messages=$(systemd-analyze verify --man=no gaitd.service 2>&1)
[[ -z $messages ]] || fail "systemd-analyze verify: $messages"

# A robot on three classic buses. Real time means little in here: slow cycles, long patience.
can_links 3 16
gaitd-fake-robot --can can-classic.yaml --period 0.01 --stall-time 0.5 --report /result/robot.json \
  >/result/robot.txt 2>&1 &
robot=$!
cat >/etc/gaitd/gaitd.yaml <<'CONFIG'
schema: gaitd.config/1
backend: socketcan
can: can-classic.yaml
period: 0.01
safety: {ready_duration: 60, sensor_timeout: 1}
log: {enabled: false}
# mine
CONFIG
mkdir -p /etc/systemd/system/gaitd.service.d
cat >/etc/systemd/system/gaitd.service.d/sandbox.conf <<'UNIT'
[Service]
ExecStartPre=/usr/bin/python3 -c "import socket, sys\n\
try: socket.socket(socket.AF_INET, socket.SOCK_STREAM); sys.exit('AF_INET is allowed')\n\
except OSError: pass\n\
try: open('/etc/gaitd/gaitd.yaml', 'a'); sys.exit('/etc is writable')\n\
except OSError: pass\n\
s = socket.socket(socket.PF_CAN, socket.SOCK_RAW, socket.CAN_RAW); s.bind(('can0',))"
UNIT
systemctl daemon-reload
systemctl start gaitd || fail "the service does not start: $(journalctl -u gaitd -n 20 --no-pager 2>&1; systemctl status gaitd --no-pager)"
[[ $(state) == disarmed ]] || fail "the service comes up '$(state)', expected disarmed"
wait_for '[[ $(systemctl show -P StatusText gaitd) == disarmed* ]]' 60
[[ $(stat -c %U "/proc/$(pid)") == gaitd ]] || fail "the service runs as $(stat -c %U "/proc/$(pid)")"
ps -L -o cls,rtprio -p "$(pid)" | grep -q 'FF *80' || fail "no thread has SCHED_FIFO 80"
(($(awk '/^VmLck/ { print $2 }' "/proc/$(pid)/status") > 10000)) || fail "memory is not locked"
[[ $(stat -c %a /run/gaitd/gaitd.sock) == 660 ]] || fail "the socket has mode $(stat -c %a /run/gaitd/gaitd.sock)"
echo "ready, disarmed, as user gaitd with SCHED_FIFO 80 and locked memory, sandboxed"

# Crash, with torque on the motors: they switch off by themselves, gaitd comes back disarmed.
gaitctl --json arm >/dev/null 2>&1 & 
wait_for '[[ $(state) == readying ]]' 60
kill -SEGV "$(pid)"
wait_for '(($(restarts) == 1)) && [[ $(state) == disarmed ]]' 200
echo "crash: restarted into disarmed"

# The control thread hangs, the others go on: the watchdog.
install /result/faulty.so /usr/lib/gaitd/faulty.so
sed -i 's|^period|state_estimator: {variant: /usr/lib/gaitd/faulty.so, fault: 7, fault_time: 2}\nperiod|' \
  /etc/gaitd/gaitd.yaml
systemctl restart gaitd
wait_for '[[ $(systemctl show -P Result gaitd) == watchdog || $(restarts) -ge 1 ]]' 200
sed -i '/faulty/d' /etc/gaitd/gaitd.yaml
wait_for '[[ $(state) == disarmed ]]' 200
echo "hang: killed by the watchdog, restarted into disarmed"

# Stop, with torque on the motors: they are switched off, not left to their timeout.
gaitctl --json arm >/dev/null 2>&1 &
wait_for '[[ $(state) == readying ]]' 60
systemctl stop gaitd
[[ $(systemctl show -P Result gaitd) == success ]] || fail "stop: $(systemctl show -P Result gaitd)"
kill -TERM "$robot"
wait "$robot" || fail "the fake robot ended with $?"
expect_json /result/robot.json "r['motors']['off'] == 30 and r['first_torque_cycle'] > 0"
expect_json /result/robot.json "sum('communication lost' in e for e in r['events']) == 30"
echo "stop: motors off by command; after the crash they had switched off by themselves"

# Upgrade: what the operator wrote stays.
dpkg -i --no-triggers --force-unsafe-io --force-confold /result/next.deb >/dev/null || fail "no upgrade"
grep -q '^# mine' /etc/gaitd/gaitd.yaml || fail "the upgrade lost the configuration"
[[ $(dpkg-query -W -f '${Version}' gaitd) == 99.0-1 ]] || fail "not upgraded"
dpkg -r --no-triggers gaitd >/dev/null || fail "no removal"
[[ ! -e /usr/bin/gaitd && -f /etc/gaitd/gaitd.yaml ]] || fail "removal: programs gone, configuration kept"
dpkg -P --no-triggers gaitd >/dev/null || fail "no purge"
[[ ! -e /etc/gaitd/gaitd.yaml ]] || fail "purged, but the configuration is there"
echo "upgraded with kept configuration, removed, purged"
echo "the service is in order"
