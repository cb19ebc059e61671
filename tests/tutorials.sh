# What the tutorials tell people to type works.
source "$(dirname "$0")/common.sh"
source "$(dirname "$0")/page.sh"

for page in docs/tutorial-first-walk.md docs/port-your-robot.md docs/tutorial-plugin.md; do
  run_page "$page"
  [[ -z $daemon ]] || stop_daemon
done
[[ -s first.html && -s knees.csv && -s my-walk.mcap && -s mine.html ]] || fail "a command left no file"
