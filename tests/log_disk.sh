# A log that cannot be written: at the start an error; later the robot walks on, the log ends with
# one message and a status, and what it holds is read.
source "$(dirname "$0")/common.sh"
cd "$scratch"

expect 1 gaitd --log /dev/full >out.txt 2>&1
grep -qF '/dev/full: cannot write the log: No space left on device; free some space' out.txt ||
  { cat out.txt; fail "a full disk at the start is not reported"; }
expect 1 gaitd --log none/log.mcap >out.txt 2>&1
grep -qF 'log.file: expected a directory, got none' out.txt ||
  { cat out.txt; fail "a folder that is not there is not reported"; }

# A limit on the size of files stands for the disk: 12 MB, a few seconds of log.
ulimit -f 12288
start_daemon --clock realtime --log log.mcap --set log.compression=none
wait_for state standing 120
expect 0 gaitctl walk --steps 8 --length 0.2
for _ in {1..1200}; do
  gaitctl --json status >status.json
  error=$(grep -o '"error": *"[^"]*"' status.json || true)
  [[ $error == *"cannot write the log"* ]] && break
  sleep 0.1
done
[[ $error == *"cannot write the log: File too large"* ]] || fail "the status says: $error"
grep -q '"open": *false' status.json || fail "a log that is not written any more is called open"
wait_for state standing 120
expect 0 gaitctl walk --steps 2 --length 0.1
wait_for state walking 60
wait_for state standing 120
stop_daemon 1
grep -q 'the log is not complete' gaitd.txt || fail "gaitd ends without a word about the log"
[[ $(grep -c 'the log ends here, the robot goes on' gaitd.txt) == 1 ]] ||
  { cat gaitd.txt; fail "not one message about the end of the log"; }
expect 4 gaitctl log info log.mcap >info.txt
grep -q 'unfinished' info.txt || fail "log info does not say that the log is cut off"
expect 4 gaitctl log export log.mcap --signals 'time,safety/state' -o log.csv
(($(wc -l <log.csv) > 100)) || fail "only $(wc -l <log.csv) lines can be read"
echo "the robot outlives its log"
