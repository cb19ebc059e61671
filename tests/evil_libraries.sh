# Who may not load code loads none: not a byte of a library is read before it is known that a swap may
# begin and that the file may be loaded. What is refused leaves nothing in memory, and a flood of swaps
# neither fills a queue nor delays the end of gaitd.
source "$(dirname "$0")/common.sh"
cd "$scratch"
bad=$GAITD_BUILD/tests/bad_plugins
export GAITD_TEST_TRACE=$scratch/trace
robot=(--backend still_robot --set log.enabled=false)
export GAITD_PATH=$bad/still_robot

# refused TEXT FILE: a swap to this file is refused with this text.
refused() {
  expect 1 gaitctl plugin swap toe_off "$2" >out.txt 2>&1
  grep -qF -- "$1" out.txt || fail "the refusal does not say '$1': $(cat out.txt)"
}
# A FIFO tells whether anybody opens it: its writer waits until then.
mkfifo fifo.so
{ true >fifo.so && touch opened; } &
writer=$!
untouched() {
  [[ ! -e opened ]] || fail "the file was opened"
  [[ ! -e trace ]] || fail "code of the library ran: $(cat trace)"
}

start_daemon "${robot[@]}"
wait_for state disarmed 20
refused 'swap.on_hardware is false' "$bad/evil.so"
refused 'swap.on_hardware is false' "$scratch/fifo.so"
refused 'swap.on_hardware is false' "$scratch/none.so"
untouched
stop_daemon
echo "without swap.on_hardware nothing of a library is touched"

mkdir allowed
cp "$bad/evil.so" allowed/good.so
ln -s "$scratch/fifo.so" allowed/link.so
start_daemon "${robot[@]}" --set swap.on_hardware=true --set "plugins.folders=[$scratch/allowed]"
wait_for state disarmed 20
refused 'plugins.folders' "$bad/evil.so"
refused 'plugins.folders' "$scratch/fifo.so"
refused 'plugins.folders' "$scratch/none.so"
refused 'plugins.folders' "$scratch/allowed/../fifo.so"
refused 'a link to elsewhere' "$scratch/allowed/link.so"
untouched
expect 0 gaitctl plugin swap toe_off never
expect 0 gaitctl plugin swap toe_off "$scratch/allowed/good.so"
[[ $(sort trace | uniq -c | tr -s ' \n' ' ') == ' 1 loaded 1 tried ' ]] ||
  fail "expected one try and one load: $(cat trace)"
expect 0 gaitctl plugin rollback toe_off
stop_daemon
kill "$writer" 2>/dev/null || true
echo "a robot loads a file from the folders of its administrator, and from no other"

# Neither a scenario nor a robot may name such a folder.
cat >wish.yaml <<'SCENARIO'
schema: gaitd.scenario/1
name: wish
robot: atlas
duration: 1
mode: walk-bent
set: {plugins.folders: [/tmp]}
expect: {no_fall: true}
SCENARIO
expect 1 gaitd --check-config wish.yaml >out.txt 2>&1
grep -q 'wish.yaml:6.*plugins.folders: only gaitd.yaml' out.txt || fail "$(cat out.txt)"
expect 1 gaitd --check-config --set 'plugins.folders=[relative]' >out.txt 2>&1
grep -q 'expected absolute paths of folders' out.txt || fail "$(cat out.txt)"

# A simulation that a person starts takes any file. A flood of it.
unset GAITD_PATH GAITD_TEST_TRACE
start_daemon --set log.enabled=false
wait_for state standing 60
maps() { grep -c . "/proc/$daemon/maps"; }
expect 0 gaitctl plugin swap toe_off "$bad/evil.so"
expect 0 gaitctl plugin rollback toe_off
before=$(maps)
for _ in {1..40}; do
  gaitctl plugin swap toe_off "$GAITD_BUILD/daemon/host/test/plugins/toe_off/crash_in_init.so" \
    >/dev/null 2>&1 && fail "a bad library was taken"
done
(($(maps) <= before + 20)) || fail "$((before)) maps became $(maps): what is refused stays in memory"
python3 - "$XDG_RUNTIME_DIR/gaitd.sock" <<'PYTHON'
import json, socket, sys
s = socket.socket(socket.AF_UNIX)
s.connect(sys.argv[1])
answers = s.makefile()
lines = b""
for i in range(400):
    method, params = ("swap", {"to": "never"}) if i < 200 else ("rollback", {})
    lines += json.dumps({"jsonrpc": "2.0", "id": i, "method": "plugin." + method,
                         "params": {"layer": "toe_off", **params}}).encode() + b"\n"
s.sendall(lines)
messages = [json.loads(answers.readline()).get("error", {}).get("message", "") for i in range(400)]
busy = sum("busy" in message for message in messages)
assert busy >= 300, messages
print(busy, "of 400 swaps and rollbacks are refused at once, all are answered")
PYTHON
[[ $(field faults) == none ]] || fail "faults: $(field faults)"
for _ in {1..8}; do
  gaitctl plugin swap toe_off "$GAITD_BUILD/daemon/host/test/plugins/toe_off/hang_at_load.so" \
    >/dev/null 2>&1 &
done
sleep 0.5
began=$SECONDS
stop_daemon
((SECONDS - began < 5)) || fail "gaitd needed $((SECONDS - began)) s to end"
echo "a flood of swaps is refused, leaves nothing, and does not delay the end"

# Nothing is left behind by a gaitd that is killed in a swap.
start_daemon --set log.enabled=false
wait_for state standing 60
gaitctl plugin swap toe_off "$GAITD_BUILD/daemon/host/test/plugins/toe_off/hang_at_load.so" \
  >/dev/null 2>&1 &
sleep 0.5
kill -KILL "$daemon"
wait "$daemon" || true
daemon=
left=$(find "$XDG_RUNTIME_DIR" -mindepth 1 ! -name 'gaitd*.sock*')
[[ -z $left ]] || fail "left: $left"
echo "a swap leaves no file behind, even after SIGKILL"

# A library that ends gaitd as it is loaded there: with 0, which the service takes for an end to mend.
grep -qx 'Restart=always' "$GAITD_SOURCE/etc/systemd/gaitd.service" || fail "no Restart=always"
