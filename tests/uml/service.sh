# The packages and the service, under the systemd of this machine in User-Mode Linux: install, ready,
# limits and sandbox, crash, hang, stop, upgrade with kept configuration, remove.
source "$(dirname "$0")/uml.sh"
source "$here/../packages_common.sh"
uml_start_or_skip
[[ -x /lib/systemd/systemd ]] || skip "no systemd on this machine"

make_packages "$scratch"
# A later version with another default configuration.
dpkg-deb -R "$scratch/gaitd.deb" "$scratch/next"
sed -i 's/^Version:.*/Version: 99.0-1/' "$scratch/next/DEBIAN/control"
echo '# of the next version' >>"$scratch/next/etc/gaitd/gaitd.yaml"
dpkg-deb -Znone -b "$scratch/next" "$scratch/next.deb" >/dev/null

cp "$GAITD_BUILD/tests/bad_plugins/state_estimator.so" "$scratch/faulty.so"
cp "$here/service_inside.sh" "$here/inside.sh" "$scratch/"
cat >"$scratch/gaitd-test.target" <<'UNIT'
[Unit]
Requires=sysinit.target gaitd-test.service
After=sysinit.target
UNIT
cat >"$scratch/gaitd-test.service" <<'UNIT'
[Unit]
After=sysinit.target
DefaultDependencies=no
SuccessAction=poweroff-immediate
FailureAction=poweroff-immediate
[Service]
Type=oneshot
TimeoutStartSec=infinity
Environment=HOME=/root
ExecStart=/bin/bash /result/service_inside.sh
StandardOutput=append:/result/service.txt
StandardError=append:/result/service.txt
UNIT
# This kernel has RT_GROUP_SCHED: in a cgroup with the cpu controller it refuses SCHED_FIFO, and one
# unit of this machine that delegates (slurmd) gives that controller to all.
uml_kernel 1700 mode=systemd script=none result="$scratch" systemd.show_status=0 loglevel=1 \
  cgroup_disable=cpu \
  systemd.mask=systemd-udevd.service systemd.mask=systemd-udev-trigger.service \
  systemd.mask=systemd-binfmt.service systemd.mask=proc-sys-fs-binfmt_misc.automount \
  >"$scratch/console.txt" 2>&1 || true
[[ -f $scratch/service.txt ]] ||
  fail "systemd did not get to the test: $(tail -n 20 "$scratch/console.txt")"
cat "$scratch/service.txt"
[[ $(tail -n 1 "$scratch/service.txt") == "the service is in order" ]] || fail "see above"
expect_report robot "r['motors']['off'] == 30 and r['first_torque_cycle'] > 0" \
  "sum('communication lost' in e for e in r['events']) == 60"
