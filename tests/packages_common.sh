# Sourced by the tests of the Debian packages, after common.sh.

# make_packages FOLDER: gaitd.deb, gaitd-dev.deb, gaitd-mujoco.deb, gaitd-tune.deb, gaitd-ros2.deb, gaitd-unitree.deb and
# python3-gaitd.deb there,
# of what is built.
make_packages() {
  local name found
  (cd "$GAITD_BUILD" && cpack -G DEB -B "$1/cpack") >"$scratch/cpack.txt" 2>&1 ||
    fail "cpack failed: $(tail -n 5 "$scratch/cpack.txt")"
  for name in gaitd gaitd-dev gaitd-mujoco gaitd-tune gaitd-ros2 gaitd-unitree python3-gaitd; do
    found=("$1/cpack/${name}"_[0-9]*_amd64.deb)
    [[ -f ${found[0]} ]] || fail "cpack made no package $name: $(tail -n 5 "$scratch/cpack.txt")"
    mv "${found[0]}" "$1/$name.deb"
  done
  rm -rf "$1/cpack"
}
