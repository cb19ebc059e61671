# The live page in a headless browser, and Foxglove's own library, with a real gaitd and `gaitctl view`.
#   view_page.sh [PICTURE]    leaves PICTURE.webp and PICTURE-phone.webp, as those of docs/images
source "$(dirname "$0")/common.sh"
picture=${1:+$(realpath "$1")}
cd "$scratch"
modules=$GAITD_BUILD/cli/page/npm/node_modules
if [[ ! -f $GAITD_BUILD/share/gaitd/view.html ]]; then
  echo "skipped: the page was not built, because npm or its registry was not there"
  exit 77
fi
if [[ ! -x ${CHROMIUM:-/usr/bin/chromium} ]]; then
  echo "skipped: no chromium; apt-get install chromium"
  exit 77
fi

start_daemon --set clock=realtime --set log.enabled=false
wait_for state standing 60
gaitctl --json view --listen 127.0.0.1:0 >pages.json 2>view.txt &
view=$!
trap 'kill "$view" 2>/dev/null; clean_up' EXIT
wait_until grep -q '}' pages.json || fail "view prints no address: $(cat view.txt)"
# token ROLE, and the address for Foxglove with it.
foxglove() { sed -n "s|.*\"$1\": \"http\(://[^#]*\)#\(token=[0-9a-f]*\)\".*|ws\1?\2|p" pages.json; }

layout=$GAITD_BUILD/share/gaitd/foxglove-layout.json
parameters=$(gaitctl --json param list | grep -o '"name":' | wc -l)
((parameters > 0)) || fail 'param list has no parameters'
for role in observe administer; do
  expect 0 node "$GAITD_SOURCE/tests/view_foxglove.mjs" "$modules" "$(foxglove $role)" $role "$layout" \
    "$parameters"
  gaitctl reset >/dev/null 2>&1 || true
  expect 0 gaitctl sim reset
  gaitctl arm >/dev/null 2>&1 || true
  wait_for state standing 60
done
expect 0 node "$GAITD_SOURCE/tests/view_page.mjs" "$modules/playwright-core" pages.json \
  "$XDG_RUNTIME_DIR/gaitd.sock" "$daemon" $picture
daemon=
kill -0 "$view" || fail "view has ended: $(cat view.txt)"
