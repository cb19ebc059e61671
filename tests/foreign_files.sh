# Files of somebody else: no scenario, robot, configuration, campaign or log runs code that it names,
# writes where it likes, or commands the terminal. With --trust, and on the word of the person at the
# command line, a library is loaded.
source "$(dirname "$0")/common.sh"
cd "$scratch"
export GAITD_TEST_MARK=$scratch/mark # the library makes this file when it is loaded
evil=$GAITD_BUILD/tests/bad_plugins/marking.so

# refused TEXT COMMAND...: ends with 1, says TEXT, and the library was not loaded.
refused() {
  expect 1 "${@:2}" >out 2>&1 || { cat out; fail "see above"; }
  grep -qF -- "$1" out || { cat out; fail "no '$1'"; }
  [[ ! -e $GAITD_TEST_MARK ]] || fail "'${*:2}' loaded the library"
}
# loads COMMAND...: ends with 0, and the library was loaded.
loads() {
  expect 0 "$@" >out 2>&1 || { cat out; fail "see above"; }
  [[ -e $GAITD_TEST_MARK ]] || fail "'$*' did not load the library"
  rm "$GAITD_TEST_MARK"
}
# scenario NAME LINE...
scenario() {
  printf 'schema: gaitd.scenario/1\nname: %s\nrobot: atlas\nduration: 3\nseed: 1\n' "$1" >"${2:-$1}.yaml"
  printf '%s\n' "${@:3}" >>"${2:-$1}.yaml"
}

scenario set set "set: {toe_off.variant: $evil}"
refused --trust gaitd --check-config set.yaml
refused --trust gaitd --scenario "$PWD/set.yaml" --clock lockstep --log set.mcap
refused --trust gaitctl run set.yaml --log set.mcap
loads gaitd --check-config set.yaml --trust
loads gaitctl run set.yaml --trust --log set.mcap

scenario backend backend "set: {backend: $evil}"
refused --trust gaitd --check-config backend.yaml
scenario swap swap 'mode: stand' "commands: [{at: 0.1, swap: {layer: toe_off, to: $evil}}]"
refused commands.swap.to gaitctl run swap.yaml --log swap.mcap
loads gaitctl run swap.yaml --trust --log swap.mcap

cp -r "$GAITD_SOURCE/robots/atlas" robot
printf 'parameters:\n  toe_off.variant: %s\n' "$evil" >>robot/robot.yaml
printf 'schema: gaitd.config/1\n' >empty.yaml # the installed one chooses the layers itself
refused --trust gaitd --config empty.yaml --check-config robot/robot.yaml
refused --trust gaitd --config empty.yaml --robot robot/robot.yaml --check-config

# The configuration that gaitd is started with may; one that is only checked may not.
printf 'schema: gaitd.config/1\ntoe_off: {variant: %s}\n' "$evil" >gaitd.yaml
refused --trust gaitd --check-config gaitd.yaml
loads gaitd --config gaitd.yaml --check-config
loads gaitd --check-config --set "toe_off.variant=$evil"

scenario plain plain 'expect: {no_fall: true}'
printf 'schema: gaitd.campaign/1\nname: c\nscenarios: [plain.yaml]\nset: {toe_off: [{variant: %s}]}\n' \
  "$evil" >c.yaml
refused --trust gaitctl campaign c.yaml -o c
loads gaitctl campaign c.yaml -o c --trust

# A log names the library that it was made with.
cp "$evil" mine.so
loads gaitctl run plain.yaml --set "toe_off.variant=$PWD/mine.so" --log mine.mcap
refused "$PWD/mine.so, which is loaded only with --trust" gaitctl log replay mine.mcap
loads gaitctl log replay mine.mcap --trust
expect 0 gaitctl log replay mine.mcap --set toe_off.variant=never >out
[[ ! -e $GAITD_TEST_MARK ]] || fail "a replay with another layer loaded the one of the log"
for command in "log info" "log export" doctor; do
  expect 0 gaitctl $command mine.mcap >out 2>&1
  [[ ! -e $GAITD_TEST_MARK ]] || fail "gaitctl $command loaded the library of the log"
done

# Drawn by a campaign, it is the word of the file as well.
printf 'schema: gaitd.campaign/1\nname: d\nscenarios: [plain.yaml]\ndraw: {toe_off.variant: {choose: [%s]}}\n' \
  "$evil" >d.yaml
refused --trust gaitctl campaign d.yaml -o d

# No file says where gaitd writes and listens.
echo precious >mine.txt
for key in log.file socket; do
  scenario places places "set: {$key: $PWD/mine.txt}"
  refused "$key: only gaitd.yaml" gaitd --scenario "$PWD/places.yaml" --clock lockstep
  refused "$key: only gaitd.yaml" gaitctl run places.yaml --log places.mcap
done
[[ $(cat mine.txt) == precious ]] || fail "a scenario overwrote a file"

# A name leads to no other folder.
mkdir logs
scenario ../x up
refused "name: expected a name for files" gaitctl run up.yaml --log logs/
scenario .hidden hidden
refused "name: expected a name for files" gaitctl run hidden.yaml --log logs/
[[ ! -e x.mcap && -z $(ls -A logs) ]] || fail "a name wrote elsewhere: $(ls -AR .)"

# Nothing of a file reaches the terminal as a command.
printf 'schema: gaitd.scenario/1\nname: "\\e[31mred"\n"\\e]0;title\\a": 1\n' >red.yaml
cp plain.yaml $'red\e[31m.yaml'
gaitctl run $'red\e[31m.yaml' --set $'no\e[31m=1' --log red.mcap >out 2>&1 || true
gaitctl run red.yaml >>out 2>&1 || true
gaitd --check-config red.yaml >>out 2>&1 || true
gaitctl log info $'no\e[31m.mcap' >>out 2>&1 || true
gaitctl --json log info $'no\e[31m.mcap' >>out 2>&1 || true
grep -q 'u001b' out || { cat -v out; fail "nothing was escaped: the test shows nothing"; }
if LC_ALL=C grep -q $'[\001-\010\013-\037\177]' out; then
  cat -v out
  fail "control characters of a file were printed"
fi
echo "foreign files are only read"
