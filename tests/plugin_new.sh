# `gaitctl plugin new`: a project for every layer, from every variant; one of them is built, and its tests pass. That of
# a backend is built by the test `backends`.
source "$(dirname "$0")/common.sh"
cd "$scratch"

for layer in state_estimator icp_planner step_adjuster toe_off whole_body_controller task_source; do
  expect 0 gaitctl plugin new "$layer" my_variant -o "$layer"
  for file in CMakeLists.txt README.md adapter.cc my_variant.cc my_variant.h \
    test/my_variant_test.cc test/walk.yaml.in; do
    [[ -s $layer/$file ]] || fail "$layer: no $file"
  done
  # Of the variant that it was copied from nothing is left in the code, of the template no gap.
  base=$(sed -n 's/^`\([a-z_]*\)`; change.*/\1/p' "$layer/README.md")
  [[ -d $GAITD_SOURCE/plugins/$layer/$base ]] || fail "$layer: README names no variant: '$base'"
  if grep -rq "$base" "$layer" --include=*.cc --include=*.h --include=CMakeLists.txt; then
    fail "$layer: the name $base is left: $(grep -rn "$base" "$layer" --include=*.cc --include=*.h)"
  fi
  if grep -rqE "@[A-Z]+@" "$layer"; then fail "$layer: a gap in the template: $(grep -rnE '@[A-Z]+@' "$layer")"; fi
  grep -q "class MyVariant" "$layer/my_variant.h" || fail "$layer: no class MyVariant"
done

# From every variant there is, with all that it includes.
for adapter in "$GAITD_SOURCE"/plugins/*/*/adapter.cc; do
  variant=$(basename "$(dirname "$adapter")")
  layer=$(basename "$(dirname "$(dirname "$adapter")")")
  expect 0 gaitctl plugin new "$layer" mine --from "$variant" -o "from_$variant"
  for header in $(sed -n 's/^#include "\([a-z_]*\.h\)"$/\1/p' "from_$variant"/*.cc "from_$variant"/*.h); do
    [[ -f from_$variant/$header ]] || fail "$variant: the project has no $header"
  done
  grep -rq "GAITD_EXPORT_LAYER(gaitd::plugins::Mine," "from_$variant" || fail "$variant: exports no Mine"
done
expect 1 gaitctl plugin new toe_off mine --from nose -o nose 2>error.txt
grep -q 'there is: icp_criteria never' error.txt || fail "an unknown variant: $(cat error.txt)"
expect 0 gaitctl plugin new backend my_engine -o backend
grep -rqiE 'mujoco(Physics|Backend|_physics|_model|_backend)' backend && fail "the name of the base is left: $(grep -rniE 'mujoco_' backend)"

# Nothing is overwritten, bad names and layers are refused.
expect 1 gaitctl plugin new toe_off my_variant -o toe_off 2>error.txt
grep -q 'is there already' error.txt || fail "an existing folder: $(cat error.txt)"
for name in My_variant 9lives 'a b' ../up ''; do
  expect 1 gaitctl plugin new toe_off "$name" 2>error.txt
  grep -q 'expected a name' error.txt || fail "the name '$name': $(cat error.txt)"
done
expect 2 gaitctl plugin new nose my_variant 2>/dev/null

# GAITD_PLUGIN_LAYERS="state_estimator icp_planner ..." builds more of them; the test backends builds one of its own.
for layer in ${GAITD_PLUGIN_LAYERS:-whole_body_controller}; do
  "${CMAKE:-cmake}" -S "$layer" -B "$layer/build" >build.txt 2>&1 &&
    "${CMAKE:-cmake}" --build "$layer/build" >>build.txt 2>&1 || fail "$layer: $(tail -n 20 build.txt)"
  if grep -i warning build.txt; then fail "$layer: warnings while building"; fi
  expect 0 "$(dirname "${CMAKE:-/usr/bin/cmake}")/ctest" --test-dir "$layer/build" --output-on-failure
done
echo "plugin projects work"
