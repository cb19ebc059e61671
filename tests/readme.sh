# What README.md tells people to type works.
source "$(dirname "$0")/common.sh"
source "$(dirname "$0")/page.sh"

run_page README.md
[[ $(field state) == standing ]] || fail "the robot ends in state $(field state)"
stop_daemon
[[ -s verdict.json && -s flat.csv && -x $HOME/gaitd/bin/gaitd ]] || fail "a command left no file"

# Every link of a page to a file of the repository leads somewhere.
for page in "$GAITD_SOURCE"/*.md "$GAITD_SOURCE"/docs/*.md; do
  while read -r link; do
    [[ -e $(dirname "$page")/$link ]] || fail "$page links to $link, which is not there"
  done < <(grep -oE '\]\([a-zA-Z.][^):]*\)' "$page" | tr -d ']()' | sed 's/#.*//' | sort -u)
done
