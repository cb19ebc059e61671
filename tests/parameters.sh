# Parameters of a running gaitd: listed, read and changed by several clients while the robot walks;
# what is wrong changes nothing. The same changes in a scenario give the same bits twice.
source "$(dirname "$0")/common.sh"

value() { gaitctl --json param get "$1" | sed -n 's/^  "value": \(.*\)$/\1/p' | tr -d ','; }
# refused CODE TEXT COMMAND...: exit code CODE and TEXT in the message.
refused() {
  local code=$1 text=$2 got=0
  shift 2
  printf '$ %s\n' "$*"
  "$@" 2>"$scratch/error" || got=$?
  ((got == code)) || fail "'$*' ended with exit code $got, expected $code"
  grep -qF -- "$text" "$scratch/error" || fail "'$*' says: $(cat "$scratch/error")"
}

start_daemon --clock realtime --log "$scratch/walk.mcap" --set swing.landing_speed=0.075
wait_for state standing 20
[[ $(value swing.landing_speed) == 0.075 ]] || fail "--set does not show in param get"
expect 0 gaitctl param list >"$scratch/list"
expect 0 gaitctl param list 'gait.*'
expect 0 gaitctl param get gait.swing_height
grep -q '^swing.landing_speed *0.075 \*' "$scratch/list" || fail "the list shows no changed value"
for key in gait.longest_step gait.touchdown_force legs.bent_knee objectives.friction safety.tilt_limit \
  limits.torque_ratio state_estimator.joint_pole icp_planner.entry_x step_adjuster.margin \
  whole_body_controller.torque_scale; do
  grep -q "^$key " "$scratch/list" || fail "the list lacks $key"
done

expect 0 gaitctl walk --steps 8 --length 0.2 --swing 0.6 --transfer 0.25
wait_for step_index 1 10
refused 1 "did you mean 'gait.swing_height'" gaitctl param set gait.swing_hight 0.12
refused 1 '0.01..0.5 m' gaitctl param set gait.swing_height 12
refused 1 'nan' gaitctl param set gait.swing_height nan
refused 1 'text' gaitctl param set gait.swing_height high
refused 1 'needs a restart' gaitctl param set period 0.002
refused 1 'not in use' gaitctl param set icp_planner/single_cmp.inwards 0.2
refused 1 'while the robot stands' gaitctl param set safety.ready_duration 2
refused 2 '' gaitctl param set gait.swing_height
[[ $(value gait.swing_height) == 0.13 ]] || fail "a refused value was taken"

# Two clients change two parameters each, at the same time, while it walks.
change() {
  local i
  for i in 5 6 7 8; do
    gaitctl param set "$1" "0.0$i" >/dev/null
    gaitctl param set "$2" "$((60 + i))" >/dev/null
  done
}
change icp_planner.entry_y objectives.pelvis_stiffness &
first=$!
change icp_planner.exit_y objectives.chest_stiffness &
wait $! || fail "the second client failed"
wait $first || fail "the first client failed"
for key in icp_planner.entry_y icp_planner.exit_y; do
  [[ $(value $key) == 0.08 ]] || fail "$key is $(value $key), expected 0.08"
done
expect 0 gaitctl param set icp_planner.entry_x -0.1
expect 0 gaitctl param set gait.swing_height 0.15
[[ $(field state) == walking ]] || fail "it does not walk any more: $(field state)"
wait_for state standing 240

# At rest; and no reset takes a change back.
expect 0 gaitctl param set safety.ready_duration 2.5
expect 0 gaitctl sim reset
wait_for state standing 20
expect 0 gaitctl estop
expect 0 gaitctl reset
expect 0 gaitctl arm
wait_for state standing 20
[[ $(value gait.swing_height) == 0.15 ]] || fail "a reset took a parameter back"
stop_daemon
gaitctl log info "$scratch/walk.mcap" >"$scratch/info"
grep -qE '^ +[0-9.]+ s  tick [0-9]+ +gait.swing_height  0.13 -> 0.15$' "$scratch/info" ||
  fail "log info does not show the change: $(cat "$scratch/info")"
changes=$(grep -cE '^ +[0-9.]+ s  tick ' "$scratch/info")
((changes == 19)) || fail "$changes changes in the log, expected 19"

# A second start knows nothing of them.
start_daemon --clock realtime --log "$scratch/again.mcap"
[[ $(value gait.swing_height) == 0.13 ]] || fail "a change outlived gaitd"
stop_daemon

# In lockstep the same changes at the same time give the same bits.
for log in a b; do
  expect 0 gaitctl run parameters --log "$scratch/$log.mcap" >/dev/null
  gaitctl log export "$scratch/$log.mcap" -o "$scratch/all.csv" \
    --signals 'time,icp/*,foot/*,joint/*'
  mv "$scratch/all.csv" "$scratch/$log.csv"
done
cmp "$scratch/a.csv" "$scratch/b.csv" || fail "two runs of the scenario differ"
gaitctl log info "$scratch/a.mcap" >"$scratch/info"
grep -q '3.000 s  tick 3000 .*gait.swing_height  0.13 -> 0.16' "$scratch/info" ||
  fail "the scenario's change is not in the log at its tick"

# A mistake in a scenario is an error before the first tick.
sed 's/gait.swing_height: 0.16/gait.swing_hight: 0.16/' \
  "$GAITD_SOURCE/sim/scenarios/parameters.yaml" >"$scratch/wrong.yaml"
expect 1 gaitd --scenario "$scratch/wrong.yaml" --check-config >"$scratch/check" 2>&1
grep -q 'did you mean' "$scratch/check" || fail "the mistake is not named: $(cat "$scratch/check")"

# docs/parameters.md is what the tables say.
gaitctl param reference >"$scratch/parameters.md"
diff -u "$GAITD_SOURCE/docs/parameters.md" "$scratch/parameters.md" ||
  fail "docs/parameters.md is old: gaitctl param reference > docs/parameters.md"
