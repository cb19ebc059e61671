# What angular momentum of the upper body is worth in balance: after a push the CMP that is asked for
# leaves the support foot while the CoP stays inside; without an excursion it never does.
source "$(dirname "$0")/common.sh"

# Pushed so hard that it takes steps: it ends 0.42 m further back.
sed -e 's/force: .*, duration/force: [-360, -360, 0], duration/' \
  -e 's/final_pelvis: .*/final_pelvis: {x: -0.43, y: 0, tolerance: 0.1}/' \
  "$GAITD_SOURCE/sim/scenarios/push-bent-diagonal.yaml" >"$scratch/push.yaml"

# share EXCURSION: of the single support in the second after it steps, in per cent, in which the
# CMP is more than 5 mm outside the sole and the CoP inside.
share() {
  gaitctl run "$scratch/push.yaml" --log "$scratch/walk.mcap" --set step_adjuster.excursion="$1" \
    >"$scratch/verdict" 2>&1 || [[ $1 == 0 ]] || fail "$(cat "$scratch/verdict")"
  gaitctl log export "$scratch/walk.mcap" -o "$scratch/walk.csv" \
    --signals 'time,gait/phase,gait/support,cmp/desired/*,cop/*,foot/*/x,foot/*/y,foot/*/yaw'
  awk -F, '
    NR == 1 { for (i = 1; i <= NF; ++i) { sub(/ .*/, "", $i); at[$i] = i } next }
    !stepped && $at["gait/phase"] != "stand" { stepped = $1 }
    # Distance outside the sole of 0.2604 m x 0.1286 m; negative inside.
    function outside(name, foot, dx, dy, yaw, u, v) {
      yaw = $at[foot "/yaw"]; dx = $at[name "/x"] - $at[foot "/x"]; dy = $at[name "/y"] - $at[foot "/y"]
      u = dx * cos(yaw) + dy * sin(yaw); v = dy * cos(yaw) - dx * sin(yaw)
      u = (u < 0 ? -u : u) - 0.1302; v = (v < 0 ? -v : v) - 0.0643
      return u > v ? u : v
    }
    stepped && $1 < stepped + 1 && $at["gait/phase"] == "swing" {
      ++ticks; foot = "foot/" $at["gait/support"]
      if (outside("cmp/desired", foot) > 0.005 && outside("cop", foot) < 0) ++used
    }
    END { printf "%.1f", ticks ? 100 * used / ticks : -1 }' "$scratch/walk.csv"
}

used=$(share 0.03)
without=$(share 0)
echo "CMP outside and CoP inside: $used % of the single support after the push, without excursion $without %"
awk -v used="$used" -v without="$without" 'BEGIN { exit !(used >= 5 && without == 0) }' ||
  fail "expected at least 5 % and none"
