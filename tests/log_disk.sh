# A log that cannot be written: at the start an error; later the robot walks on, the log stops with
# one message and a status, goes on in a further file when it can, and what it holds is read.
source "$(dirname "$0")/common.sh"
cd "$scratch"

expect 1 gaitd --log /dev/full >out.txt 2>&1
grep -qF '/dev/full: cannot write the log: No space left on device; free some space' out.txt ||
  { cat out.txt; fail "a full disk at the start is not reported"; }
expect 1 gaitd --log none/log.mcap >out.txt 2>&1
grep -qF 'log.file: expected a directory, got none' out.txt ||
  { cat out.txt; fail "a folder that is not there is not reported"; }

# The log of one gaitd is not emptied by another one.
start_daemon --clock realtime --log taken.mcap
wait_for state standing 120
expect 1 gaitd --clock realtime --log taken.mcap >out.txt 2>&1
grep -q 'taken.mcap: cannot write the log: .*; another process writes it' out.txt || { cat out.txt; fail "two logs in one"; }
stop_daemon 0
expect 0 gaitctl log info taken.mcap >info.txt

# A limit on the size of files stands for the disk: 4 MB, a few seconds of log.
ulimit -S -f 4096
start_daemon --clock realtime --log log.mcap
wait_for state standing 120
expect 0 gaitctl walk --steps 8 --length 0.2
# wait_for_log PATTERN: in the part of the status about the log.
wait_for_log() {
  for _ in {1..1200}; do
    gaitctl --json status | sed -n '/"log": {/,/}/p' >status.txt
    tr -d '\n' <status.txt | grep -q "$1" && return
    sleep 0.1
  done
  fail "the status never says $1: $(cat status.txt)"
}
wait_for_log '"error": *"[^"]*cannot write the log: File too large.*"open": *false'
[[ $(field state) == walking || $(field state) == standing ]] || fail "the robot is $(field state)"
# Then there is room again.
prlimit --pid "$daemon" --fsize=unlimited
wait_for_log '"open": *true.*"part": *2'
wait_for state standing 120
expect 0 gaitctl walk --steps 2 --length 0.1
wait_for state walking 60
wait_for state standing 120
lost=$(gaitctl --json status | tr -d '\n' | sed 's/.*"dropouts": *\([0-9]*\).*/\1/')
stop_daemon 1
grep -q 'the log is not complete' gaitd.txt || fail "gaitd ends without a word about the log"
[[ $(grep -c 'the log stops here until there is room, the robot goes on' gaitd.txt) == 1 ]] ||
  { cat gaitd.txt; fail "not one message about the end of the log"; }
grep -q "log: goes on in log-2.mcap; $lost ticks are lost" gaitd.txt ||
  fail "not told how many ticks are lost, expected $lost"
expect 4 gaitctl log info log.mcap >info.txt
grep -q 'unfinished' info.txt || fail "log info does not say that the log is cut off"
expect 4 gaitctl log export log.mcap --signals 'time,safety/state' -o log.csv
(($(wc -l <log.csv) > 100)) || fail "only $(wc -l <log.csv) lines can be read"
expect 0 gaitctl log export log-2.mcap --signals 'time,safety/state' -o log-2.csv
# One period for each tick that is in neither file. Of the chunk that was cut off, a second of ticks at
# most, readers save what gaitd counts as lost.
missing=$(awk -v end="$(tail -n 1 log.csv | cut -d, -f1)" \
  'NR == 2 { printf "%d", ($1 - end) / 0.001 + 0.5 - 1 }' FS=, log-2.csv)
((missing > 1000 && lost >= missing && lost - missing <= 1000)) ||
  fail "$missing ticks are missing, $lost are called lost"
echo "the robot outlives its log, $lost ticks are lost"
