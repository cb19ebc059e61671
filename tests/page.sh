# Sourced after common.sh by the tests of pages. run_page FILE takes every ```sh block of a page in
# order and runs its lines in a folder that looks like a fresh clone with a finished build, with these
# differences:
#   ./run-demo     as ./run-demo --no-build --no-page: the build is done, and nobody looks
#   ./run-tests    only looked for: it is what runs this test
#   python/run-notebooks  with --no-build
#   gaitd ...      in the background, until the end or the next one
# `gaitctl report` is left out where its page could not be built for want of npm.
clone=$scratch/clone
mkdir -p "$clone/build"
for entry in "$GAITD_SOURCE"/* "$GAITD_SOURCE"/.[!.]*; do
  name=$(basename "$entry")
  [[ $name == build || $name == .git ]] || ln -s "$entry" "$clone/$name"
done
# What writes into its own folder must not write into the source tree.
rm "$clone/run-demo" "$clone/cmake"
cp -r "$GAITD_SOURCE/run-demo" "$GAITD_SOURCE/cmake" "$clone/"
ln -s "$GAITD_BUILD" "$clone/build/release"
cd "$clone"
# The programs are found as README.md says, not by the PATH of the tests.
export PATH="$(dirname "${CMAKE:-/usr/bin/cmake}"):/usr/local/bin:/usr/bin:/bin"

run_block() {
  local line=$1
  case "$line" in
    ./run-tests) [[ -x run-tests ]] || fail "run-tests cannot be executed" ;;
    ./run-demo) expect 0 ./run-demo --no-build --no-page ;;
    python/run-notebooks) expect 0 python/run-notebooks --no-build ;;
    'gaitd '*--check-config) eval "expect 0 $line" ;;
    gaitd*)
      read -ra words <<<"$line"
      start_daemon "${words[@]:1}"
      wait_for state standing 20
      ;;
    'gaitctl report '*)
      if [[ -e $GAITD_BUILD/share/gaitd/report.html ]]; then
        eval "expect 0 $line"
      else
        echo "left out: $line"
      fi
      ;;
    'gaitctl walk '*)
      eval "expect 0 $line"
      sleep 1
      ;;
    'gaitctl stop')
      expect 0 gaitctl stop
      wait_for state standing 20
      ;;
    'gaitctl sim reset')
      expect 0 gaitctl sim reset
      wait_for state standing 20
      ;;
    'gaitctl steps '*)
      eval "expect 0 $line"
      wait_for state walking 5
      wait_for state standing 20
      ;;
    *)
      printf '$ %s\n' "$line"
      eval "$line" || fail "'$line' ended with exit code $?"
      ;;
  esac
}

run_page() {
  local lines i command end
  # One command per line; a here-document belongs to the line that begins it.
  mapfile -t lines < <(commands_of "$1")
  ((${#lines[@]} >= 5)) || fail "$1 has only ${#lines[@]} lines of commands"
  for ((i = 0; i < ${#lines[@]}; ++i)); do
    command=${lines[i]}
    if [[ $command =~ \<\<\'?([A-Z]+)\'?$ ]]; then
      end=${BASH_REMATCH[1]}
      until [[ ${lines[i]} == "$end" ]]; do
        i=$((i + 1))
        command+=$'\n'${lines[i]}
      done
    fi
    run_block "$command"
  done
  echo "all ${#lines[@]} lines of $1 work"
}
