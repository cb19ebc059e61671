# What docs/python.md tells people to type works: the script, the notebooks, and the installation by pip, which then needs
# nothing of the source tree.
source "$(dirname "$0")/common.sh"
source "$(dirname "$0")/page.sh"

run_page docs/python.md
for name in walk step-adjuster tune-a-gain; do
  grep -q 'data:image/png\|<svg' "build/notebooks/$name.html" || fail "the notebook $name shows no plot"
done
[[ -s my-walk.mcap && -s my-walk.mcap.columns ]] || fail "the script left no log"

unset PYTHONPATH
python=$PWD/my-env/bin/python
cd /
installed=$("$python" -c 'import gaitd; print(gaitd.__file__); gaitd.find_program("gaitctl")')
[[ $installed == "$clone/my-env/"* ]] || fail "the package comes from $installed"
"$python" -m pip show gaitd | grep '^Requires: numpy$' >/dev/null || fail "the package does not say that it needs numpy"
