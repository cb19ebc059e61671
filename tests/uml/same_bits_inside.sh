gaitctl run "$GAITD_SOURCE/tests/uml/short_walk.yaml" --log inside1.mcap >inside1.txt 2>&1 &
gaitctl run "$GAITD_SOURCE/tests/uml/short_walk.yaml" --log inside2.mcap >inside2.txt 2>&1 ||
  fail "the walk fails inside: $(tail -n 5 inside2.txt)"
wait $! || fail "the walk fails inside: $(tail -n 5 inside1.txt)"
