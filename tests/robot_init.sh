# Twelve made-up humanoids, as different as published ones are, are described by `gaitctl robot init`
# alone and walk, without an edit.
source "$(dirname "$0")/common.sh"

robots=(tiny spheres sideways tilted toes backwards nameless twisted crouched skewed rooted bare)
python3 "$GAITD_SOURCE/tests/made_up_robots.py" "$scratch/urdf"

expect 1 gaitctl robot init "$scratch/urdf/bare/bare.urdf" -o "$scratch/bare" 2>"$scratch/bare.txt"
grep -q 'no shape to find the sole from.*--sole LENGTH' "$scratch/bare.txt" || fail "bare: $(cat "$scratch/bare.txt")"

for name in "${robots[@]}"; do
  folder=$scratch/$name
  told=()
  [[ $name == bare ]] && told=(--sole 0.108,0.054,0.0405,0.0225)
  start=$(date +%s%N)
  expect 0 gaitctl robot init "$scratch/urdf/$name/$name.urdf" -o "$folder" "${told[@]}" >"$folder.txt"
  took=$((($(date +%s%N) - start) / 1000000))
  ((took <= 5000)) || fail "$name: robot init took $took ms, expected at most 5000"
  for file in robot.yaml stand.yaml walk.yaml posture.svg; do
    [[ -s $folder/$file ]] || fail "$name: no $file"
  done
  gaitd --robot "$folder/robot.yaml" --check-config >>"$folder.txt" 2>&1 ||
    fail "$name: $(cat "$folder.txt")"
  printf '%-10s described in %d ms\n' "$name" "$took"
done

# What they are about.
grep -q 'rpy: \[0, 0, 1.5707963\]' "$scratch/sideways/robot.yaml" || fail "sideways: no turned pelvis"
grep -q 'link: torso_imu\|link: chest' "$scratch/spheres/robot.yaml" || fail "spheres: IMU not in the chest"
grep -q 'left_finger_2_joint  # mimics' "$scratch/spheres/robot.yaml" || fail "spheres: mimic not fixed"
grep -q 'left_toe  # a toe' "$scratch/toes/robot.yaml" || fail "toes: not fixed"
grep -q 'neck  # the URDF gives no effort' "$scratch/toes/robot.yaml" || fail "toes: neck not fixed"
grep -q 'pelvis: pelvis' "$scratch/rooted/robot.yaml" || fail "rooted: the pelvis is not body 0"
grep -q 'left_knee: {effort: .*, velocity: .*, range: \[' "$scratch/bare/robot.yaml" || fail "bare: no drive_limits"
grep -q 'left_ft of the URDF' "$scratch/tilted/robot.yaml" || fail "tilted: force sensor not found"
sed '/^  left_knee: {effort/d' "$scratch/bare/robot.yaml" >"$scratch/bare/less.yaml"
expect 1 gaitd --robot "$scratch/bare/less.yaml" --check-config >"$scratch/less.txt" 2>&1
grep -q 'drive_limits: expected effort and velocity of left_knee, which the URDF does not give' "$scratch/less.txt" ||
  fail "bare: $(cat "$scratch/less.txt")"

# What is there already stays.
expect 1 gaitctl robot init "$scratch/urdf/tiny/tiny.urdf" -o "$scratch/tiny" 2>/dev/null
expect 1 gaitctl robot init "$scratch/urdf/no.urdf" -o "$scratch/no" 2>/dev/null
[[ ! -e $scratch/no ]] || fail "a folder was made for no robot"

printf '%s\n' "${robots[@]}" | xargs -P2 -I{} bash -c \
  "gaitctl run $scratch/{}/walk.yaml -v >$scratch/{}.walk 2>&1 || touch $scratch/{}.fell"
walked=0
for name in "${robots[@]}"; do
  if [[ -e $scratch/$name.fell ]]; then
    printf '%-10s does not walk:\n%s\n' "$name" "$(grep -v '^ *$' "$scratch/$name.walk" | head -12)"
  else
    walked=$((walked + 1))
    printf '%-10s walks\n' "$name"
  fi
done
((walked == ${#robots[@]})) || fail "$walked of ${#robots[@]} robots walk as they were described"
printf '%d of 12 robots walk as they were described\n' "$walked"
