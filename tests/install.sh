# An installation works on its own, wherever it is, and takes nothing from the source tree.
source "$(dirname "$0")/common.sh"
prefix=$scratch/prefix

"${CMAKE:-cmake}" --install "$GAITD_BUILD" --prefix "$prefix" >"$scratch/install.txt" ||
  fail "cmake --install failed: $(tail -n 3 "$scratch/install.txt")"
for file in bin/gaitd bin/gaitctl etc/gaitd/gaitd.yaml share/gaitd/robots/atlas/robot.yaml \
  share/gaitd/robots/atlas/atlas.urdf share/gaitd/scenarios/flat-0.35.yaml \
  share/gaitd/campaigns/model-errors.yaml share/gaitd/foxglove-layout.json \
  lib/gaitd/plugins/backend/simbody.so include/gaitd/abi/plugin.h \
  lib/cmake/gaitd/gaitd-config.cmake lib/libgaitd_walking.a include/gaitd/walking/icp_reference.h \
  share/man/man1/gaitctl.1 share/man/man8/gaitd.8 share/zsh/site-functions/_gaitctl \
  share/bash-completion/completions/gaitctl share/bash-completion/completions/gaitd \
  share/fish/vendor_completions.d/gaitctl.fish; do
  [[ -f $prefix/$file ]] || fail "not installed: $file"
done
[[ ! -e $prefix/share/gaitd/robots/CMakeLists.txt ]] || fail "CMakeLists.txt was installed"

# Built trees and installed ones find each other's files by accident on the machine of a developer:
# only the installation may be opened.
export PATH="$prefix/bin:/usr/bin:/bin"
cd "$scratch"
expect 0 gaitctl run stand --set duration=2 --log "$scratch/stand.mcap"
gaitctl --json run stand --set duration=0.1 --log "$scratch/x.mcap" >"$scratch/report.json" || true
grep -q "\"file\": \"$prefix/share/gaitd/scenarios/stand.yaml\"" "$scratch/report.json" ||
  fail "the scenario did not come from $prefix"
# What authors of plugins need: a new project finds it.
expect 0 gaitctl plugin new toe_off my_toe_off
"${CMAKE:-cmake}" -S my_toe_off -B my_toe_off/build >configure.txt 2>&1 ||
  fail "a plugin project does not find the installation: $(tail -n 5 configure.txt)"
grep -q "gaitd_DIR:PATH=$prefix/lib/cmake/gaitd" my_toe_off/build/CMakeCache.txt ||
  fail "the project takes another gaitd: $(grep gaitd_DIR my_toe_off/build/CMakeCache.txt)"
start_daemon --log "$scratch/log.mcap"
gaitctl plugin list | grep -q "$prefix/lib/gaitd/plugins/" || fail "no plugins from $prefix"
if gaitctl plugin list | grep -q "$GAITD_BUILD"; then fail "plugins of the build tree are used"; fi
stop_daemon
