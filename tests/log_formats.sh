# A log opens elsewhere: with the official MCAP reader from npm, whole and cut off, and holds the
# standard messages of Foxglove.
source "$(dirname "$0")/common.sh"
cd "$scratch"
modules=$GAITD_BUILD/cli/page/npm/node_modules
for module in @mcap/core fzstd protobufjs; do
  if [[ ! -d $modules/$module ]]; then
    echo "skipped: $modules/$module is not there, because npm or its registry was not"
    exit 77
  fi
done
gaitctl run straight-0.35 --set duration=4 --log walk.mcap >/dev/null 2>&1 || true
expect 0 node "$GAITD_SOURCE/tests/log_formats.mjs" "$modules" walk.mcap
size=$(stat -c %s walk.mcap)
for share in 97 61 33; do
  head -c $((size * share / 100 + 7)) walk.mcap >cut.mcap
  expect 0 node "$GAITD_SOURCE/tests/log_formats.mjs" "$modules" cut.mcap cut
done
