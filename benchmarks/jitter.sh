#!/usr/bin/env bash
# How late gaitd wakes up in real time, beside cyclictest (package rt-tests) in the same minutes: pairs of
# runs, one after the other, with clients that ask for the status 100 times a second, a log being written and a
# swap every 5 s. Prints both distributions of each pair, and the median of the ratios of p99.
#   benchmarks/jitter.sh [SECONDS] [PAIRS]          60 and 5 unless given
# $GAITD_BUILD is the build, build/release by default. Exit code 0 if the ratio is at most 1.3.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
seconds=${1:-60} pairs=${2:-5}
export PATH="${GAITD_BUILD:-$PWD/build/release}/bin:$PATH"
command -v cyclictest >/dev/null || {
  echo "error: no cyclictest; apt-get install rt-tests" >&2
  exit 1
}
scratch=$(mktemp -d)
socket=$scratch/gaitd.sock
started=()
trap 'kill "${started[@]}" 2>/dev/null || true; rm -rf "$scratch"' EXIT

# distribution NAME: of lines with µs on standard input; p99 goes to $scratch/NAME.
distribution() {
  sort -n | awk -v name="$1" -v file="$scratch/$1" '
    { v[NR] = $1 }
    END {
      if (!NR) { print name ": nothing measured"; exit 1 }
      p99 = v[int(0.99 * (NR - 1)) + 1]
      printf "  %-11s %7d wake-ups  p50 %8.1f  p90 %8.1f  p99 %8.1f  p99.9 %8.1f  max %9.1f us\n",
        name, NR, v[int(0.5 * (NR - 1)) + 1], v[int(0.9 * (NR - 1)) + 1], p99,
        v[int(0.999 * (NR - 1)) + 1], v[NR]
      print p99 > file
    }'
}

run_gaitd() {
  gaitd --clock realtime --socket "$socket" --log "$scratch/log.mcap" >"$scratch/gaitd.txt" 2>&1 &
  local daemon=$!
  started=("$daemon")
  local client=(gaitctl --socket "$socket")
  for _ in {1..300}; do
    "${client[@]}" status 2>/dev/null | grep -x 'state *standing' >/dev/null && break
    sleep 0.1
  done
  "${client[@]}" walk --steps 1000 --length 0.02 >/dev/null
  for _ in 1 2; do # each at 50 Hz
    "${client[@]}" watch --interval 0.02 >/dev/null 2>&1 &
    started+=("$!")
  done
  local end=$((SECONDS + seconds)) variant=never
  while ((SECONDS < end)); do
    "${client[@]}" plugin swap toe_off "$variant" >/dev/null || true
    [[ $variant == never ]] && variant=icp_criteria || variant=never
    sleep 3.5 # a swap takes a second and a half
  done
  kill -INT "$daemon"
  wait "$daemon" || true
  wait "${started[@]:1}" 2>/dev/null || true
  started=()
  gaitctl log export "$scratch/log.mcap" --signals tick/jitter_us | tail -n +1000 |
    distribution gaitd
  grep 'real time' "$scratch/gaitd.txt" | sed 's/^\[[^]]*\] */  /' >"$scratch/got.txt"
}

# Of its histogram of whole µs, each value as often as it was met.
run_cyclictest() {
  cyclictest -m -p 80 -i 1000 -D "$seconds" -q -h 100000 |
    awk '!/^#/ && NF == 2 { for (i = 0; i < $2; ++i) print $1 + 0 }' | distribution cyclictest
}

ratios=()
for ((pair = 1; pair <= pairs; ++pair)); do
  echo "pair $pair of $pairs, $seconds s each"
  run_cyclictest
  run_gaitd
  ratios+=("$(paste "$scratch/gaitd" "$scratch/cyclictest" | awk '{ print $1 / $2 }')")
  echo "  p99 of gaitd over that of cyclictest: ${ratios[-1]}"
done
cat "$scratch/got.txt"
median=$(printf '%s\n' "${ratios[@]}" | sort -n | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }')
echo "median ratio of p99: $median"
awk -v ratio="$median" 'BEGIN { exit ratio > 1.3 }'
