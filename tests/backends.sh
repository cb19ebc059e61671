# What docs/backend.md tells people to type works, its example is a backend that gaitd starts, and both
# physics engines agree about a walk.
source "$(dirname "$0")/common.sh"
cd "$scratch"

mapfile -t lines < <(commands_of docs/backend.md)
((${#lines[@]} >= 5)) || fail "docs/backend.md has only ${#lines[@]} lines of commands"
export PATH="$(dirname "${CMAKE:-/usr/bin/cmake}"):$PATH"
for line in "${lines[@]}"; do
  printf '$ %s\n' "$line"
  eval "$line" >out.txt 2>&1 || fail "'$line' ended with exit code $?: $(tail -n 20 out.txt)"
  if [[ $line == *--build* ]] && grep -i warning out.txt; then fail "warnings while building"; fi
done

cp -r "$GAITD_SOURCE/docs/examples/backend" example
"${CMAKE:-cmake}" -S example -B example/build -DCMAKE_PREFIX_PATH="$GAITD_BUILD" >build.txt 2>&1 &&
  "${CMAKE:-cmake}" --build example/build >>build.txt 2>&1 || fail "the example: $(tail -n 20 build.txt)"
still=$scratch/example/build/lib/gaitd/plugins/backend/still_robot.so
expect 0 gaitctl plugin check "$still"
start_daemon --backend "$still" --log "$scratch/still.mcap"
[[ $(field backend) == still_robot ]] || fail "status names the backend $(field backend)"
wait_for state disarmed 30
expect 1 gaitctl sim reset 2>error.txt
stop_daemon
gaitctl log info "$scratch/still.mcap" | grep -q still_robot || fail "the log does not name its backend"

# The median over steps of the same walk, on both engines, within 30 %.
for scenario in straight-0.35 turn; do
  for engine in simbody mujoco; do
    gaitctl --json run "$scenario" --log "$engine.mcap" --set backend="$engine" \
      --set actuators.model=nominal >"$engine.json" 2>/dev/null || true
  done
  python3 - "$scenario" <<'PYTHON' || fail "the engines do not agree about $scenario"
import json, sys
icp = [json.load(open(f"{engine}.json"))["scenarios"][0]["verdict"]["figures"]["icp_error_rms"]
       for engine in ("simbody", "mujoco")]
print(f"{sys.argv[1]}: ICP error {1e3 * icp[0]:.2f} mm on Simbody, {1e3 * icp[1]:.2f} mm on MuJoCo")
sys.exit(not (icp[0] > 0 and abs(icp[1] / icp[0] - 1) < 0.3))
PYTHON
done
