# Sourced by run-demo and run-tests in the folder of the repository: packages, configuration, build.

PACKAGE_LIST=cmake/debian-packages.txt
BUILD=build/release

say() { printf '\n== %s\n' "$*"; }
die() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}

# missing_packages demo|notebooks|tests
missing_packages() {
  local package rest=0 chapter=
  while read -r package; do
    [[ $package == '# all the rest'* ]] && rest=1
    [[ $package == \#* ]] && chapter=$package
    [[ $1 == demo ]] && ((rest)) && break
    [[ $1 == notebooks ]] && ((rest)) && [[ $chapter != '# the Python package and its notebooks' ]] && continue
    [[ -z $package || $package == \#* ]] && continue
    # node.org's nodejs brings its own npm, and Debian's does not go beside it.
    [[ $package == npm ]] && command -v npm >/dev/null && continue
    dpkg-query -W -f '${db:Status-Abbrev}\n' "$package" 2>/dev/null | grep -q '^ii' ||
      echo "$package"
  done <"$PACKAGE_LIST"
}

# install_packages demo|notebooks|tests
install_packages() {
  local as_root=()
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    printf 'This is no Debian: taking the packages in %s for installed.\n' "$PACKAGE_LIST"
    return
  fi
  local missing
  mapfile -t missing < <(missing_packages "$1")
  ((${#missing[@]} == 0)) && return
  if ((EUID != 0)); then
    command -v sudo >/dev/null || die "missing packages, and neither root nor sudo to install them.
  As root: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  say "Installing ${missing[*]}"
  "${as_root[@]}" apt-get update ||
    die "apt-get update failed; check the network and /etc/apt/sources.list"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y --no-install-recommends "${missing[@]}" ||
    die "apt-get could not install ${missing[*]}; gaitd is built and tested on Debian 12"
}

# set_up_and_build demo|notebooks|tests: the demo needs neither tests nor what only they need, the notebooks the
# Python package besides. All share one build tree: what is there already stays, whoever comes first.
set_up_and_build() {
  install_packages "$1"
  local options=(-UGAITD_COMPONENTS -UGAITD_BUILD_TESTS -UGAITD_BUILD_BENCHMARKS) targets=()
  if [[ $1 != tests ]]; then
    targets=(--target programs)
    [[ $1 == notebooks ]] && targets+=(gaitd_python)
    [[ -f $BUILD/CMakeCache.txt ]] && options=(-UGAITD_COMPONENTS) || options=(-DGAITD_BUILD_TESTS=OFF -DGAITD_BUILD_BENCHMARKS=OFF)
  fi
  say "Configuring $BUILD"
  cmake --preset release "${options[@]}" ||
    die "the configuration failed, see above; $PACKAGE_LIST lists what it needs"
  say "Building $BUILD on $(nproc) cores"
  cmake --build --preset release --parallel "$(nproc)" "${targets[@]}" || die "the build failed, see above"
}
