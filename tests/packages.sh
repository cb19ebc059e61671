# The Debian packages: what they hold, that a plugin builds against gaitd-dev alone, and how exposed
# the service is.
source "$(dirname "$0")/common.sh"

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

messages=$(systemd-analyze verify --man=no "$scratch/root/lib/systemd/system/gaitd.service" 2>&1 |
  grep -v 'gaitd is not executable' || true)
[[ -z $messages ]] || fail "systemd-analyze verify: $messages"
for file in etc/gaitd/gaitd.yaml usr/lib/sysusers.d/gaitd.conf usr/lib/tmpfiles.d/gaitd.conf \
  usr/share/doc/gaitd/examples/network/80-can-fd.network usr/bin/gaitd-fake-robot; do
  [[ -f $scratch/root/$file ]] || fail "not in the package: $file"
done
