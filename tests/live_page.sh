# The page of `gaitctl view` in a headless browser, with a server that has no gaitd.
source "$(dirname "$0")/common.sh"
page=$GAITD_BUILD/share/gaitd/view.html
if [[ ! -f $page ]]; then
  echo "skipped: $page was not built, because npm or its registry was not there"
  exit 77
fi
if grep -qE '(src|href)="?https?:' "$page"; then fail "the page loads something from elsewhere"; fi
grep -q "Content-Security-Policy.*default-src 'none'" "$page" || fail "the page forbids itself nothing"
# Where the packages of the page are, so that none of its tests is skipped.
cp -r "$GAITD_SOURCE/cli/page"/{src,test,package.json} "$scratch"
ln -s "$GAITD_BUILD/cli/page/npm/node_modules" "$scratch/node_modules"
(cd "$scratch" && expect 0 node --test >tests.txt) || fail "$(cat "$scratch/tests.txt")"
grep -q '^# skipped 0' "$scratch/tests.txt" || fail "$(grep -A3 SKIP "$scratch/tests.txt")"
expect 0 node "$GAITD_SOURCE/tests/live_page.mjs" "$GAITD_BUILD/cli/page/npm/node_modules/playwright-core" \
  "$page" "$GAITD_SOURCE/robots/atlas/atlas.urdf"
