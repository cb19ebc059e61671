# The packages and the service, under the systemd of this machine in User-Mode Linux: install, ready,
# limits and sandbox, crash, hang, stop, upgrade with kept configuration, remove.
source "$(dirname "$0")/uml.sh"

# Outside: both packages, unpacked into a folder, are enough to build a plugin.
(cd "$GAITD_BUILD" && cpack -G DEB) >"$scratch/cpack.txt" 2>&1 ||
  fail "cpack failed: $(tail -n 5 "$scratch/cpack.txt")"
version=$(sed -n 's/^project(gaitd VERSION \([0-9.]*\).*/\1/p' "$GAITD_SOURCE/CMakeLists.txt")
debs=$GAITD_BUILD/packages
for name in gaitd gaitd-dev; do
  [[ -f $debs/${name}_$version-1_amd64.deb ]] || fail "no package $name in $debs"
  dpkg-deb -x "$debs/${name}_$version-1_amd64.deb" "$scratch/root"
done
"${CMAKE:-cmake}" -S "$scratch/root/usr/share/doc/gaitd-dev/examples/plugin" -B "$scratch/plugin" \
  -DCMAKE_PREFIX_PATH="$scratch/root/usr" >"$scratch/plugin.txt" 2>&1 &&
  "${CMAKE:-cmake}" --build "$scratch/plugin" >>"$scratch/plugin.txt" 2>&1 ||
  fail "the example plugin does not build: $(tail -n 20 "$scratch/plugin.txt")"
expect 0 "$scratch/root/usr/bin/gaitctl" plugin check \
  "$scratch/plugin/lib/gaitd/plugins/toe_off/late.so" >"$scratch/check.txt"
tail -n 1 "$scratch/check.txt"
printf '#include "gaitd/walking/gait_machine.h"\nint main() {}\n' >"$scratch/pc.cc"
export PKG_CONFIG_PATH=$scratch/root/usr/lib/pkgconfig
# shellcheck disable=SC2046
c++ "$scratch/pc.cc" -o "$scratch/pc" $(pkg-config --cflags --libs gaitd) ||
  fail "pkg-config gaitd gives flags that do not work"

score=$(systemd-analyze security --offline=yes "$GAITD_SOURCE/etc/systemd/gaitd.service" |
  sed -n 's/.*exposure level for gaitd.service: \([0-9.]*\).*/\1/p')
echo "exposure score $score"
awk -v score="$score" 'BEGIN { exit !(score > 0 && score <= 2.0) }' ||
  fail "the exposure score is '$score', expected at most 2.0"

# A later version with another default configuration.
dpkg-deb -R "$debs/gaitd_$version-1_amd64.deb" "$scratch/next"
sed -i 's/^Version:.*/Version: 99.0-1/' "$scratch/next/DEBIAN/control"
echo '# of the next version' >>"$scratch/next/etc/gaitd/gaitd.yaml"
dpkg-deb -b "$scratch/next" "$scratch/next.deb" >/dev/null

uml_start_or_skip
cp "$debs/gaitd_$version-1_amd64.deb" "$scratch/gaitd.deb"
cp "$GAITD_BUILD/tests/bad_plugins/state_estimator.so" "$scratch/faulty.so"
# Inside, /tmp is another one.
cp "$here/service_inside.sh" "$here/inside.sh" "$scratch/"
cat >"$scratch/gaitd-test.target" <<'UNIT'
[Unit]
Requires=sysinit.target gaitd-test.service
After=sysinit.target
UNIT
cat >"$scratch/gaitd-test.service" <<UNIT
[Unit]
After=sysinit.target dbus.socket
Wants=dbus.socket
DefaultDependencies=no
SuccessAction=poweroff-immediate
FailureAction=poweroff-immediate
[Service]
Type=oneshot
Environment=HOME=/root
ExecStart=/bin/bash /result/service_inside.sh
StandardOutput=append:/result/service.txt
StandardError=append:/result/service.txt
UNIT
# The drop-in of the test checks the sandbox from inside it, before gaitd starts.
uml_kernel 1200 mode=systemd script=none result="$scratch" systemd.show_status=0 loglevel=1 \
  >"$scratch/console.txt" 2>&1 || true
[[ -f $scratch/service.txt ]] || fail "systemd did not get to the test: $(tail -n 20 "$scratch/console.txt")"
cat "$scratch/service.txt"
[[ $(tail -n 1 "$scratch/service.txt") == "the service is in order" ]] || fail "see above"
