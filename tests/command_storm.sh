# Random commands, most of them wrong, from several clients against a walking robot in lockstep.
# gaitd lives, every refusal names its reason, and the robot moves, to the bit, as it does when it
# gets only the commands that were accepted, at the same ticks. For another storm, or a longer one:
# GAITD_STORM_SEED, GAITD_STORM_COUNT.
source "$(dirname "$0")/common.sh"
seed=${GAITD_STORM_SEED:-1}
count=${GAITD_STORM_COUNT:-10000}

# storm NAME REPLAY
storm() {
  local code=0
  echo "$1: seed $seed, $count requests"
  GAITD_PATH=$GAITD_BUILD/tests/storm \
    GAITD_STORM_BACKEND=$GAITD_BUILD/lib/gaitd/plugins/backend/simbody.so \
    GAITD_STORM_FOLDER=$scratch GAITD_STORM_SOCKET=$scratch/gaitd.sock \
    GAITD_STORM_SEED=$seed GAITD_STORM_COUNT=$count GAITD_STORM_REPLAY=$2 \
    gaitd --clock lockstep --socket "$scratch/gaitd.sock" --set log.enabled=false >"$scratch/gaitd.txt" 2>&1 || code=$?
  ((code == 0)) || fail "gaitd ended with exit code $code"
  [[ -s $scratch/$1.json ]] || fail "the storm did not come to its end"
  grep -q '"failures": \[\]' "$scratch/$1.json" || {
    sed -n '/"failures"/,/\]/p' "$scratch/$1.json" >&2
    fail "see above"
  }
}

storm storm 0
cat "$scratch/storm.json"
storm replay 1
cmp "$scratch/storm.ticks" "$scratch/replay.ticks" ||
  fail "refused commands left a trace: the first differing byte over 8 is the tick"
ticks=$(($(wc -c <"$scratch/storm.ticks") / 8))
accepted=$(wc -l <"$scratch/accepted.jsonl")
((ticks > 1000 && accepted > count / 50)) || fail "only $accepted accepted in $ticks ticks"
echo "$ticks ticks are identical with and without the refused commands"
