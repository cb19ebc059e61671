# gaitd --check-config: all that a start would check, all errors at once, 0 or 1.
source "$(dirname "$0")/common.sh"

as=()  # what gaitd is started by

# refused TEXT... -- ARGUMENTS...: the check fails and says all of the texts.
refused() {
  local texts=() text
  while [[ $1 != -- ]]; do
    texts+=("$1")
    shift
  done
  shift
  expect 1 "${as[@]}" gaitd --check-config "$@" >"$scratch/out.txt" 2>&1
  for text in "${texts[@]}"; do
    grep -qF -- "$text" "$scratch/out.txt" ||
      { cat "$scratch/out.txt"; fail "'$*' does not say: $text"; }
  done
}

cd "$scratch"
cp -r "$GAITD_SOURCE/robots/atlas" robot
robot=robot/robot.yaml

# What is in order, given in each of the ways.
expect 0 gaitd --check-config
expect 0 gaitd --check-config "$GAITD_SOURCE/etc/gaitd.yaml"
expect 0 gaitd --check-config "$robot"
expect 0 gaitd --check-config "$GAITD_SOURCE/sim/scenarios/turn.yaml"
expect 0 gaitd --robot "$robot" --scenario turn --check-config
expect 2 gaitd "$robot"

# The commands of docs/configuration.md, in a clone.
(
  cd "$GAITD_SOURCE"
  while read -r line; do
    eval "expect 0 $line"
  done < <(commands_of docs/configuration.md)
)

# Every error of all files at once, with its place and what would be right.
cat >wrong.yaml <<'YAML'
schema: gaitd.config/1
robot: robot/wrong.yaml
clock: realtimee
step_adjuster: {variant: fixed_step, gain: 1}
toe_off: {variant: never, speed: 1}
gait: {swing_duration: 900}
log: {directory: /no/such/folder}
YAML
sed 's/^chest: utorso/chest: utorsoo/; s/l_leg_kny: 0.5/l_leg_kny: 9/' "$robot" >robot/wrong.yaml
cat >wrong-scenario.yaml <<'YAML'
schema: gaitd.scenario/1
name: wrong
robot: robot/wrong.yaml
duration: 5
mode: walk-bent
commands:
  - {at: 9, walk: {steps: 1}}
YAML
refused 'wrong.yaml:3: clock: expected one of realtime, lockstep' "did you mean 'realtime'?" \
  'wrong.yaml:4: step_adjuster.variant: ' fixed_steps \
  'wrong.yaml:5: toe_off.speed: unknown key' \
  'wrong.yaml:6: gait.swing_duration: expected a number' \
  'wrong.yaml:7: log.directory: expected a directory, got /no/such/folder' \
  "wrong.yaml:6: chest: expected a link of the URDF, got utorsoo; did you mean 'utorso'?" \
  'posture.l_leg_kny: expected a position' \
  'wrong-scenario.yaml:7: commands[0].at: expected a time before the end' \
  -- --config wrong.yaml --scenario wrong-scenario.yaml --robot robot/wrong.yaml
grep -qF 'step_adjuster.gain: unknown' out.txt && fail "blames parameters of a missing plugin"

# Each kind of file that is none.
refused 'none.yaml: expected a file, got nothing there' -- none.yaml
refused 'robot: expected a file, got something else' -- robot
: >empty.yaml
refused 'empty.yaml: expected a YAML document' -- empty.yaml
printf 'schema: gaitd.config/1\nperiod:\t0.001\n\tclock: realtime\n' >tab.yaml
refused 'tab.yaml:3: not YAML' -- tab.yaml
printf 'schema: gaitd.config/1\nrobot: \377\376\n' >bytes.yaml
refused 'bytes.yaml' 'UTF-8' -- bytes.yaml
printf 'schema: gaitd.config/1\na: &a [*a]\n' >loop.yaml
refused 'loop.yaml:2: an alias refers to a value that contains it' -- loop.yaml
printf 'schema: gaitd.other/1\n' >other.yaml
refused "other.yaml:1: schema: expected gaitd.config/1, gaitd.robot/1 or gaitd.scenario/1" \
  -- other.yaml
truncate -s 5M large.yaml
refused 'large.yaml: expected at most 1048576 bytes, got 5242880' -- large.yaml

# The URDF of a robot, with its own lines.
sed 's/^urdf: .*/urdf: none.urdf/' "$robot" >robot/no-urdf.yaml
refused 'robot/no-urdf.yaml:4: urdf: ' 'robot/none.urdf: cannot be read' -- robot/no-urdf.yaml
sed 's/<axis xyz="0 1 0"/<axis xyz="0 0 0"/' robot/atlas.urdf >robot/bad.urdf
sed 's/^urdf: .*/urdf: bad.urdf/' "$robot" >robot/bad-urdf.yaml
refused 'robot/bad.urdf:' 'the axis is zero' -- robot/bad-urdf.yaml

# Places where no log can be written.
mkdir file-or-folder
refused 'log.file: expected a file' -- --log file-or-folder
# Rights hold for root as well once it gives up the capability to overrule them.
overrule=-dac_override,-dac_read_search
((EUID != 0)) || as=(setpriv --bounding-set "$overrule" --inh-caps "$overrule")
mkdir -m 500 closed
refused 'log.file: expected a directory to write in' -- --log closed/log.mcap
chmod 000 "$robot"
refused 'cannot be read' -- "$robot"
echo "every file that is wrong is refused with its place"
