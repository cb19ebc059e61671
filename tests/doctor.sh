# `gaitctl doctor`: of falls with a cause that was planted, of walks without one, of robots with
# mistakes, of this machine.
source "$(dirname "$0")/common.sh"
cd "$scratch"
cp "$GAITD_SOURCE"/tests/falls/*.yaml .
mkdir robot
cp "$GAITD_SOURCE"/robots/atlas/robot.yaml robot/
atlas=$GAITD_SOURCE/robots/atlas/atlas.urdf

# diagnose LOG: its first finding is in $first, the text in doctor.txt.
diagnose() {
  gaitctl --json doctor "$1" >doctor.json 2>doctor.err || true
  gaitctl doctor "$1" >doctor.txt 2>/dev/null || true
  first=$(sed -n '/"first": {/,/}/s/.*"check": "\(.*\)",*/\1/p' doctor.json)
}
# fall CHECK TEXT: falls/CHECK.yaml ends badly, and doctor names CHECK first, with TEXT.
fall() {
  gaitctl run "$1.yaml" --log "$1.mcap" >run.txt 2>&1 && fail "fall-$1 did not fall"
  expect 1 gaitctl doctor "$1.mcap" >/dev/null
  diagnose "$1.mcap"
  [[ $first == "$1" ]] || { cat doctor.txt; fail "fall-$1: doctor names '$first' first"; }
  sed -n 3p doctor.txt | grep -q "$2" || { cat doctor.txt; fail "fall-$1: nothing said of '$2'"; }
  printf '%s\n' "$(sed -n '3,4p' doctor.txt)"
}
fall torque 'torque limits, most of all [lr]_leg'
fall slip 'slid on the ground'
fall push 'towards -y for 0\.[12]'
fall load '[23][0-9]\.[0-9] kg were put on'
fall handhold 'the right hand was torn off'
fall pull 'towards +y for [1-9]'
fall cop 'the CoP stood on the edge of the feet'
fall weight '% more'
fall estimate 'gyro and leg joints disagree'
fall solver 'max_iterations'
fall footstep 'lies .* from the standing foot'
fall sensors 'ms old'
sed 's/lower="-1" upper="0.7"/lower="-0.3" upper="0.7"/' "$atlas" >robot/atlas.urdf
fall joint 'leg_aky came to its lower position limit of -0.300'

# A layer that takes 4 ms from 1.2 s on, in real time.
GAITD_TEST_FAULT=5 GAITD_TEST_FAULT_TIME=1.2 timeout 120 gaitd --scenario timing.yaml \
  --clock realtime --log timing.mcap --set realtime.overrun=stop \
  --set toe_off.variant="$GAITD_BUILD/tests/bad_plugins/toe_off.so" >timing.txt 2>&1 || true
diagnose timing.mcap
[[ $first == timing ]] || { cat doctor.txt; fail "late ticks: doctor names '$first' first"; }
sed -n '3,4p' doctor.txt

# A walk without a fall; a log that is none, or cut off.
gaitctl run flat-0.35 --set duration=6 --log walk.mcap >/dev/null 2>&1 || true
expect 0 gaitctl doctor walk.mcap >walk.txt
grep -q 'no fall and no fault' walk.txt || { cat walk.txt; fail "a walk is not called well"; }
grep -q ' s  ' walk.txt && { cat walk.txt; fail "something is found in a good walk"; }
head -c 3000000 torque.mcap >cut.mcap
expect 4 gaitctl doctor cut.mcap >/dev/null 2>cut.txt
grep -q 'cut off' cut.txt || fail "nothing said of the cut: $(cat cut.txt)"
echo nonsense >none.mcap
expect 1 gaitctl doctor none.mcap 2>/dev/null
expect 1 gaitctl doctor nobody 2>/dev/null
expect 2 gaitctl doctor --nonsense 2>/dev/null

# robot CODE TEXT SED...: a copy of Atlas with a mistake.
robot() {
  local code=$1 text=$2
  shift 2
  sed "$@" "$atlas" >robot/atlas.urdf
  gaitctl doctor robot/robot.yaml >robot.txt && got=0 || got=$?
  grep -q "$text" robot.txt || { cat robot.txt; fail "a robot: nothing said of '$text'"; }
  ((got == code)) || { cat robot.txt; fail "a robot ($text): exit code $got, expected $code"; }
  grep "$text" robot.txt
}
expect 0 gaitctl doctor atlas
robot 0 'on both legs\|% of its limit' -e 's/x/x/'
grep -q warning robot.txt && { cat robot.txt; fail "a warning about a sound robot"; }
robot 1 'inertia' -e '0,/ixx="[^"]*"/s//ixx="9.9"/'
robot 0 'in size (radius of gyration)' -e 's/<mass value="9.509"/<mass value="0.05"/'
robot 0 'is the mass of the whole robot' -e 's/<mass value="9.509"/<mass value="900"/'
robot 0 'placeholder' -e '0,/effort="[^"]*"/s//effort="1e6"/'
robot 0 'and 29 other joints: 1e+06 N m' -e 's/effort="[^"]*"/effort="1e6"/g; s/velocity="[^"]*"/velocity="12"/g'
robot 1 '% of its limit' -e 's/effort="890"/effort="60"/'
cp "$GAITD_SOURCE"/robots/atlas/robot.yaml flipped.yaml
sed 's/name: pelvis_imu, link: pelvis, xyz: \[0, 0, 0\], rpy: \[0, 0, 0\]/name: pelvis_imu, link: pelvis, xyz: [0, 0, 0], rpy: [3.1416, 0, 0]/' \
  flipped.yaml >robot/robot.yaml
robot 0 'imu pelvis_imu: its z axis' -e 's/x/x/'

# Warnings are no failure: a machine without CAN interfaces can simulate.
gaitctl doctor >machine.txt || grep -q problem machine.txt || fail "doctor of the machine failed"
for check in kernel priority memory governor wake-ups can; do
  grep -q " $check " machine.txt || { cat machine.txt; fail "nothing said of $check"; }
done
gaitctl --json doctor | grep -q '"check": "kernel"' || fail "no JSON"
echo "every planted cause was found"
