# A walk in lockstep, daemon and plant together, takes little of one processor: with ideal drives and with
# hydraulic ones and the sensors of a laboratory. docs/performance.md has the figures.
source "$(dirname "$0")/common.sh"

core=$(taskset -cp $$ | sed -E 's/.*: ([0-9]+).*/\1/')
TIMEFORMAT='%U %S'

# walk TIMES RATIO SCENARIO ARGUMENTS...: simulated seconds over those of the processor have to be more than
# TIMES; and the ms of the processor for a simulated second over the µs of the calibration, which compares
# between machines, less than RATIO. What others do on the machine slows single runs down, so the first run of
# five that is fast enough counts.
walk() {
  local times=$1 ratio=$2 seconds duration before after
  shift 2
  for _ in {1..5}; do
    before=$(taskset -c "$core" "$GAITD_BUILD/tests/calibration")
    { time taskset -c "$core" gaitctl run -v "$@" --log "$scratch/walk.mcap" >"$scratch/out" 2>&1; } \
      2>"$scratch/time" || true  # the verdict is for others
    after=$(taskset -c "$core" "$GAITD_BUILD/tests/calibration")
    seconds=$(awk '{ print $1 + $2 }' "$scratch/time")
    duration=$(awk '$1 == "duration" { print $2 }' "$scratch/out")
    grep -q '^ *realtime_factor [ 0-9.]*$' "$scratch/out" || {
      cat "$scratch/out"
      fail "the verdict has no realtime_factor"
    }
    awk -v name="$*" -v s="$seconds" -v d="$duration" -v c="$before" -v e="$after" -v t="$times" -v r="$ratio" '
      BEGIN {
        if (d < 10) { print name ": the walk ended after " d " s"; exit 1 }
        if (e < c) c = e
        got = 1000 * s / d / c
        printf "%s: %.1f s in %.2f s of a processor, %.2f times real time; over the calibration of %.2f µs %.0f\n",
          name, d, s, d / s, c, got
        exit !(d > t * s && got < r)
      }' && return
  done
  fail "too slow: more than $times times real time and less than $ratio calibrations wanted"
}

walk 2.0 120 flat-0.35
walk 2.0 130 straight-0.35 --set actuators.model=hydraulic --set sensors.noise=lab --set calibration=hydraulic
