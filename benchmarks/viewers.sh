#!/usr/bin/env bash
# What live viewers cost gaitd: the time of a tick of a robot that walks in real time, without `gaitctl view`, and
# with one that has 20 viewers at 30 frames a second and one more that reads nothing. Pairs of runs, one after the
# other, the first of a pair in turns. Prints both medians of each pair and the median of their ratios.
#   benchmarks/viewers.sh [SECONDS] [PAIRS]          20 and 5 unless given
# $GAITD_BUILD is the build, build/release by default. Exit code 0 if the ratio is at most 1.05.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
seconds=${1:-20} pairs=${2:-5}
export PATH="${GAITD_BUILD:-$PWD/build/release}/bin:$PATH"
scratch=$(mktemp -d)
socket=$scratch/gaitd.sock
started=()
trap 'kill "${started[@]}" 2>/dev/null || true; rm -rf "$scratch"' EXIT
client=(gaitctl --socket "$socket")

# viewers SECONDS: 21 of them for that time; how many frames a second they got.
viewers() {
  python3 - "$scratch/pages.json" "$1" <<'PYTHON'
import json, re, select, statistics, sys, time
sys.path.insert(0, "tests")
from view_client import Viewer
port, token = re.match(r"http://127\.0\.0\.1:(\d+)/#token=(\w+)", json.load(open(sys.argv[1]))["observe"]).groups()
stalled = Viewer(int(port), token)
viewers = [Viewer(int(port), token) for _ in range(20)]
for viewer in viewers:
    viewer.send({"type": "rate", "hz": 30})
    viewer.shown = 0
begin = time.monotonic()
while (passed := time.monotonic() - begin) < float(sys.argv[2]):
    for viewer in select.select(viewers, [], [], 0.1)[0]:
        viewer.receive(0.05)
        while len(viewer.data) > 2 and viewer.receive(0.01):
            pass
        viewer.shown += len(viewer.frames)
        viewer.frames.clear()
        viewer.messages.clear()
rates = [viewer.shown / passed for viewer in viewers]
print(f"{statistics.median(rates):.1f} frames/s each, {min(rates):.1f} the fewest")
PYTHON
}

# measure NAME: a walk, with viewers if NAME is so; its median goes to $scratch/NAME.
measure() {
  gaitd --clock realtime --socket "$socket" --log "$scratch/log.mcap" >"$scratch/gaitd.txt" 2>&1 &
  local daemon=$! frames='' first
  started=("$daemon")
  for _ in {1..300}; do
    "${client[@]}" status 2>/dev/null | grep -x 'state *standing' >/dev/null && break
    sleep 0.1
  done
  if [[ $1 == viewers ]]; then
    "${client[@]}" --json view --listen 127.0.0.1:0 >"$scratch/pages.json" &
    started+=("$!")
    for _ in {1..100}; do grep -q '}' "$scratch/pages.json" && break || sleep 0.1; done
  fi
  "${client[@]}" walk --steps 1000 --length 0.02 >/dev/null
  sleep 2
  first=$("${client[@]}" --json status | sed -n 's/^ *"tick": \([0-9]*\).*/\1/p' | tail -n 1)
  if [[ $1 == viewers ]]; then frames=$(viewers "$seconds"); else sleep "$seconds"; fi
  kill -INT "$daemon"
  wait "$daemon" || true
  kill "${started[@]:1}" 2>/dev/null || true
  wait "${started[@]:1}" 2>/dev/null || true
  started=()
  gaitctl log export "$scratch/log.mcap" --signals tick/total_us | tail -n "+$((first + 2))" | sort -n |
    awk -v name="$1" -v file="$scratch/$1" -v frames="$frames" '
      { v[NR] = $1 }
      END {
        if (!NR) { print name ": nothing measured"; exit 1 }
        p50 = v[int(0.5 * (NR - 1)) + 1]
        printf "  %-8s %6d ticks  p50 %7.2f  p90 %7.2f  p99 %7.2f us  %s\n",
          name, NR, p50, v[int(0.9 * (NR - 1)) + 1], v[int(0.99 * (NR - 1)) + 1], frames
        print p50 > file
      }'
}

ratios=()
for ((pair = 1; pair <= pairs; ++pair)); do
  echo "pair $pair of $pairs, $seconds s each, load $(cut -d' ' -f1 /proc/loadavg)"
  if ((pair % 2)); then order=(none viewers); else order=(viewers none); fi
  for name in "${order[@]}"; do measure "$name"; done
  ratios+=("$(paste "$scratch/viewers" "$scratch/none" | awk '{ printf "%.3f", $1 / $2 }')")
  echo "  with viewers over without: ${ratios[-1]}"
done
median=$(printf '%s\n' "${ratios[@]}" | sort -n | awk '{ v[NR] = $1 } END { printf "%.3f", (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2 }')
echo "median ratio of the medians: $median"
awk -v ratio="$median" 'BEGIN { exit ratio > 1.05 }'
