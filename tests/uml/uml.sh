# Sourced by the tests that run in User-Mode Linux: a kernel with CAN, as an ordinary program. Gives
# uml_start_or_skip, uml_run, uml_kernel and expect_report. Exit code 77: skipped.
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
uml=$GAITD_BUILD/tests/uml
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

skip() {
  printf 'SKIPPED: %s\n' "$*"
  exit 77
}

# The kernel, and an initramfs with busybox and its modules; made anew when this folder changed.
uml_start_or_skip() {
  local tool modules release file
  for tool in linux.uml busybox cpio depmod ip; do
    command -v "$tool" >/dev/null || skip "no $tool: install user-mode-linux busybox-static cpio kmod iproute2"
  done
  [[ $EUID == 0 ]] || skip "User-Mode Linux gives its root the rights of this user: root is needed"
  mkdir -p "$uml"
  exec 9>"$uml/lock"
  flock 9
  if [[ ! $uml/initrd.gz -nt $here/init || ! $uml/initrd.gz -nt $here/uml.sh ]]; then
    release=$(linux.uml --version)
    modules=/usr/lib/uml/modules/$release
    rm -rf "$uml/root"
    mkdir -p "$uml/root"/{bin,dev,proc,sys,host,upper,root,lib/modules/"$release"}
    cp "$(command -v busybox)" "$uml/root/bin/"
    install -m 755 "$here/init" "$uml/root/init"
    for module in can can-raw can-dev vcan slcan overlay autofs4; do
      file=$(find "$modules" -name "$module.ko")
      [[ -n $file ]] || skip "the kernel of user-mode-linux has no module $module"
      install -D "$file" "$uml/root/lib/modules/$release/${file#"$modules"/}"
    done
    depmod -b "$uml/root" "$release" 2>/dev/null
    (cd "$uml/root" && find . | cpio -o -H newc 2>/dev/null | gzip) >"$uml/initrd.gz"
  fi
  flock -u 9
  [[ $uml/boots -nt $uml/initrd.gz ]] && return
  # Some sandboxes forbid ptrace, which User-Mode Linux needs.
  printf 'exit 0\n' >"$scratch/hello.sh"
  uml_kernel 300 mode=chroot script="$scratch/hello.sh" result="$scratch" >"$scratch/hello.txt" 2>&1 || true
  [[ -f $scratch/code ]] || skip "User-Mode Linux does not boot here: $(tail -n 3 "$scratch/hello.txt")"
  rm "$scratch/code"
  touch "$uml/boots"
}

# uml_kernel SECONDS ARGUMENTS...
uml_kernel() {
  local seconds=$1
  shift
  ulimit -n "$(ulimit -H -n)" # every file open inside is one outside
  TMPDIR=/dev/shm timeout --kill-after=5 "$seconds" linux.uml mem=1G initrd="$uml/initrd.gz" \
    con=null con0=fd:0,fd:1 quiet umid="gaitd$$" uml_dir="$scratch/" "$@" </dev/null
}

# uml_run SCRIPT SECONDS: a script of this folder inside, with $scratch, $GAITD_BUILD and the PATH of
# outside. It fails the test unless it ends with 0. $uml_arguments go to the kernel.
uml_arguments=()
uml_run() {
  local code=none
  rm -f "$scratch/code"
  cat >"$scratch/inside.sh" <<INSIDE
export PATH=$PATH:/usr/sbin:/sbin HOME=$HOME XDG_RUNTIME_DIR=/run
export GAITD_BUILD=$GAITD_BUILD GAITD_SOURCE=$GAITD_SOURCE scratch=$scratch
cd $scratch
source $here/inside.sh
source $here/$1
INSIDE
  uml_kernel "$2" mode=chroot script="$scratch/inside.sh" result="$scratch" "${uml_arguments[@]}" 2>&1 | grep --line-buffered -v '^SELinux' || true
  [[ -f $scratch/code ]] && code=$(cat "$scratch/code")
  [[ $code == 0 ]] || fail "$1 ended with $code inside User-Mode Linux"
}

# expect_report NAME EXPRESSION...: python on the report `r` that the fake robot left.
expect_report() {
  python3 -S - "$scratch/$1.json" "${@:2}" <<'PYTHON' || fail "$1.json: see the expression above"
import json, sys
r = json.load(open(sys.argv[1]))
for expression in sys.argv[2:]:
    if not eval(expression):
        print("expected", expression)
        print(json.dumps(r))
        sys.exit(1)
PYTHON
}
