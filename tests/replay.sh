# A log is replayed to the same bits: a walk in lockstep with a push, commands, parameters and swaps,
# and one in real time with clients. A changed layer shows its difference.
source "$(dirname "$0")/common.sh"
cd "$scratch"

cat >walk.yaml <<'SCENARIO'
schema: gaitd.scenario/1
name: replayed
robot: atlas
duration: 64
seed: 3
mode: walk-straight
sensors: {noise: nominal}
actuators: {model: nominal}
commands:
  - {at: 1.0, walk: {steps: 66, length: 0.3}}
  - {at: 4.0, pose: {hand: {side: left, frame: pelvis, x: 0.45, y: 0.35, z: 0.3}}}
  - {at: 5.0, pose: {arm: {side: right, points: [{time: 1, joints: {r_arm_elx: -1.2}}, {time: 2, joints: {r_arm_elx: -0.5}}]}}}
  - {at: 6.0, param: {gait.swing_height: 0.12, swap.probation: 0.9}}
  - {at: 8.0, swap: {layer: whole_body_controller, to: com_height_qp}}
  - {at: 12.0, mode: walk-bent}
  - {at: 16.0, swap: {layer: whole_body_controller, to: nullspace_qp}}
  - {at: 20.0, pause: true}
  - {at: 24.0, resume: true}
  - {at: 18.0, footsteps: [{side: left, x: 25.0, y: 0.13}, {side: right, x: 25.0, y: -0.13}]}
disturbances:
  - {link: utorso, force: [0, 60, 0], duration: 0.1, when: {time: 10.0}}
expect: {no_fall: true, refused_commands: 1}
SCENARIO
# One of these commands is refused: the footsteps come while it walks, on the wrong side.
gaitctl run walk.yaml --log walk.mcap >run.out 2>&1 || true
gaitctl log info walk.mcap | sed -n 1,12p
expect 0 gaitctl log replay walk.mcap | tee replay.out
grep -q 'identical' replay.out || fail "$(cat replay.out)"
grep -qE ' in [6-9][0-9]{4} ticks' replay.out || fail "too short a walk: $(cat replay.out)"

# Another layer: the first tick, layer and signal, and how far it goes.
expect 0 gaitctl --json log replay walk.mcap --set step_adjuster.gain_parallel=4.5 \
  >changed.json || { cat changed.json; fail "replay with another parameter"; }
grep -q '"identical": false' changed.json || fail "a changed parameter makes no difference"
grep -m 1 '"layer"' changed.json | grep -q 'step_adjuster' ||
  fail "the first that differs is not the layer that was changed: $(head -n 12 changed.json)"
expect 1 gaitctl log replay walk.yaml 2>/dev/null
expect 1 gaitctl log replay walk.mcap --set no.such=1 2>/dev/null
expect 2 gaitctl log replay 2>/dev/null

# In real time: clients, a swap by hand, a rollback.
start_daemon --clock realtime --log live.mcap
wait_for state standing 60
expect 0 gaitctl walk --steps 8 --length 0.2
expect 0 gaitctl plugin swap toe_off never
expect 0 gaitctl param set gait.swing_duration 0.65
expect 0 gaitctl sim push --link utorso --force 0,30,0 --duration 0.1
expect 0 gaitctl plugin rollback toe_off
expect 0 gaitctl stop
wait_for state standing 60
expect 0 gaitctl sim reset
wait_for state standing 60
stop_daemon
expect 0 gaitctl log replay live.mcap
