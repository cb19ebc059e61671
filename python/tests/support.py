"""Imported by every test first: a home of its own, and a short walk to look at."""

import atexit
import os
import shutil
import subprocess
import tempfile

SCRATCH = tempfile.mkdtemp(prefix="gaitd-test-")
atexit.register(shutil.rmtree, SCRATCH, ignore_errors=True)
for variable, folder in (("HOME", "home"), ("XDG_RUNTIME_DIR", "run"), ("XDG_CACHE_HOME", "cache")):
    os.environ[variable] = os.path.join(SCRATCH, folder)
    os.mkdir(os.environ[variable], 0o700)
os.environ.pop("XDG_STATE_HOME", None)

import gaitd  # noqa: E402

WALK = {
    "name": "short",
    "robot": "atlas",
    "duration": 4.0,
    "seed": 1,
    "mode": "walk-bent",
    "sensors": {"noise": "nominal"},
    "actuators": {"model": "ideal"},
    "commands": [{"at": 1.0, "walk": {"steps": 2, "length": 0.25}}],
    "expect": {"no_fall": True, "steps_taken": 2},
}


def scratch(name):
    """The path of a file in the folder of this test."""
    return os.path.join(SCRATCH, name)


def gaitctl(*arguments, code=0):
    """What gaitctl prints; its exit code must be the one given."""
    done = subprocess.run([gaitd.find_program("gaitctl"), *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == code, f"gaitctl {arguments}: {done.returncode}: {done.stderr}"
    return done.stdout
