# What the tutorials tell people to type works.
source "$(dirname "$0")/common.sh"
source "$(dirname "$0")/page.sh"

for page in docs/tutorial-first-walk.md docs/tutorial-carry.md docs/port-your-robot.md docs/tutorial-plugin.md; do
  run_page "$page"
  [[ -z $daemon ]] || stop_daemon
done
[[ -s knees.csv && -s my-walk.mcap ]] || fail "a command left no file"
