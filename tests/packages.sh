# The Debian packages: what they hold, that a plugin builds against gaitd-dev alone, and how exposed
# the service is. tests/uml/service.sh installs them.
source "$(dirname "$0")/common.sh"
source "$(dirname "$0")/packages_common.sh"

make_packages "$scratch"
root=$scratch/root
for name in gaitd gaitd-dev gaitd-mujoco gaitd-tune gaitd-ros2 gaitd-unitree python3-gaitd; do dpkg-deb -x "$scratch/$name.deb" "$root"; done
for file in etc/gaitd/gaitd.yaml usr/lib/sysusers.d/gaitd.conf usr/lib/tmpfiles.d/gaitd.conf \
  usr/lib/udev/rules.d/60-gaitd.rules etc/security/limits.d/gaitd.conf \
  lib/systemd/system/gaitd.service usr/share/doc/gaitd/docs/configuration.md usr/share/doc/gaitd/examples/network/80-can-fd.network \
  usr/bin/gaitd usr/bin/gaitctl usr/bin/gaitd-fake-robot \
  usr/lib/gaitd/plugins/backend/socketcan.so usr/lib/gaitd/plugins/backend/mujoco.so usr/share/gaitd/robots/atlas/can-fd.yaml \
  usr/bin/gaitd-ros2 usr/share/man/man8/gaitd-ros2.8 lib/systemd/system/gaitd-ros2.service \
  usr/lib/gaitd/plugins/backend/unitree_dds.so usr/lib/gaitd/gaitd-unitree-link usr/lib/gaitd/gaitd-cma-es usr/bin/gaitd-fake-g1 \
  usr/share/doc/gaitd-unitree/examples/unitree.conf \
  usr/include/gaitd/abi/plugin.h usr/lib/cmake/gaitd/gaitd-config.cmake; do
  [[ -f $root/$file ]] || fail "not in the packages: $file"
done
if grep -rIl "$GAITD_SOURCE" "$root" >"$scratch/foreign.txt"; then
  fail "these files name the source tree: $(cat "$scratch/foreign.txt")"
fi

[[ $(dpkg-deb -f "$scratch/gaitd.deb" Depends) != *mujoco* ]] || fail "gaitd depends on MuJoCo"
[[ $(dpkg-deb -f "$scratch/gaitd-mujoco.deb" Depends) == *libmujoco* ]] ||
  fail "gaitd-mujoco does not depend on MuJoCo"
[[ $(dpkg-deb -f "$scratch/gaitd.deb" Depends) != *pagmo* ]] || fail "gaitd depends on pagmo"
[[ $(dpkg-deb -f "$scratch/gaitd-tune.deb" Depends) == *libpagmo* ]] || fail "gaitd-tune does not depend on pagmo"
[[ $(dpkg-deb -f "$scratch/gaitd.deb" Depends) != *ddsc* ]] || fail "gaitd depends on DDS"
[[ $(dpkg-deb -f "$scratch/gaitd-ros2.deb" Depends) == *libddsc* ]] || fail "gaitd-ros2 does not depend on DDS"
[[ $(dpkg-deb -f "$scratch/gaitd-unitree.deb" Depends) == *libddsc* ]] || fail "gaitd-unitree does not depend on DDS"
contents=$(dpkg-deb -c "$scratch/gaitd.deb" | grep -v /usr/share/doc/gaitd/docs/)
[[ -z $(grep unitree <<<"$contents" || true) ]] || fail "files of gaitd-unitree are in gaitd"
[[ -z $(grep ros2 <<<"$contents" || true) ]] || fail "files of gaitd-ros2 are in gaitd"
[[ $(dpkg-deb -f "$scratch/python3-gaitd.deb" Depends) =~ python3\ \(\>=\ 3.*gaitd\ \(=.*python3-numpy ]] ||
  fail "python3-gaitd depends on $(dpkg-deb -f "$scratch/python3-gaitd.deb" Depends)"
PYTHONPATH=$root/usr/lib/python3/dist-packages /usr/bin/python3 -c "
import gaitd
assert gaitd.find_program('gaitctl') == '$root/usr/bin/gaitctl', gaitd.find_program('gaitctl')
log = gaitd.run('stand', set={'duration': 0.1}, log='$scratch/stand.mcap').log
assert log.ticks >= 100 and log['pelvis/z'].shape == (log.ticks,), log" || fail "the installed Python package does not work"
[[ -z $(grep python <<<"$contents" || true) ]] || fail "files of python3-gaitd are in gaitd"
python3 "$GAITD_SOURCE/tests/installed_headers.py" "$root/usr" ||
  fail "headers are installed that cannot be used"

# The example project, copied out, finds nothing but the installed packages.
cp -r "$root/usr/share/doc/gaitd-dev/examples/plugin" "$scratch/project"
{
  "${CMAKE:-cmake}" -S "$scratch/project" -B "$scratch/project/build" \
    -DCMAKE_PREFIX_PATH="$root/usr" && "${CMAKE:-cmake}" --build "$scratch/project/build"
} >"$scratch/plugin.txt" 2>&1 ||
  fail "the example plugin does not build: $(tail -n 20 "$scratch/plugin.txt")"
late=$scratch/project/build/lib/gaitd/plugins/toe_off/late.so
expect 0 "$root/usr/bin/gaitctl" plugin check "$late" >"$scratch/check.txt"
tail -n 1 "$scratch/check.txt"
printf '#include "gaitd/walking/gait_machine.h"\nint main() {}\n' >"$scratch/pc.cc"
export PKG_CONFIG_PATH=$root/usr/lib/pkgconfig
# shellcheck disable=SC2046
c++ "$scratch/pc.cc" -o "$scratch/pc" $(pkg-config --cflags --libs gaitd) ||
  fail "pkg-config gaitd gives flags that do not work"

# exposed UNIT SCORE: which of them may be at most, and what systemd says of the unit.
exposed() {
  local score messages
  score=$(systemd-analyze security --offline=yes "$GAITD_SOURCE/etc/systemd/$1" |
    sed -n "s/.*exposure level for $1: \([0-9.]*\).*/\1/p")
  echo "exposure score of $1: $score"
  awk -v score="$score" -v most="$2" 'BEGIN { exit !(score > 0 && score <= most) }' ||
    fail "the exposure score of $1 is '$score', expected at most $2"
  messages=$(systemd-analyze verify --man=no "$root/lib/systemd/system/$1" 2>&1 |
    grep -v 'is not executable' || true)
  [[ -z $messages ]] || fail "systemd-analyze verify: $messages"
}
exposed gaitd.service 2.0
exposed gaitd-ros2.service 2.0
