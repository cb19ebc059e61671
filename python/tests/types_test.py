"""The package is typed: mypy finds nothing in it, and in a program that uses it just what is wrong."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import gaitd

# Lines end in `# wrong` where the checker has to object.
_PROGRAM = '''
import gaitd
import numpy as np

log = gaitd.Log("walk.mcap")
time: "np.ndarray[tuple[int], np.dtype[np.float64]]" = log.time
knee: float = float(log["joint/l_leg_kny/position"][0])
with gaitd.connect() as robot:
    robot.walk(6, length=0.3)
    status = robot.wait("standing", timeout=30)
    robot.wait(30.0)  # wrong
    robot.walk("six")  # wrong
    robot.run()  # wrong
ticks: int = log.ticks
name: str = log.ticks  # wrong
'''


def _mypy(*arguments: str) -> "subprocess.CompletedProcess[str]":
    command = ["/usr/bin/mypy", "--strict", "--ignore-missing-imports", "--cache-dir", os.devnull, *arguments]
    environment = {**os.environ, "MYPYPATH": str(Path(gaitd.__file__).parent.parent)}
    return subprocess.run(command, capture_output=True, text=True, env=environment)


@unittest.skipUnless(os.path.exists("/usr/bin/mypy"), "no mypy; install the packages of cmake/debian-packages.txt")
class Types(unittest.TestCase):
    def test_the_package_is_what_it_says(self) -> None:
        found = _mypy(str(Path(gaitd.__file__).parent))
        self.assertEqual(found.returncode, 0, found.stdout + found.stderr)

    def test_a_program_is_checked_against_it(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            program = Path(folder) / "program.py"
            program.write_text(_PROGRAM)
            found = _mypy(str(program)).stdout
        wrong = [at for at, line in enumerate(_PROGRAM.split("\n"), 1) if line.endswith("# wrong")]
        blamed = sorted({int(line.split(":")[1]) for line in found.splitlines() if ": error:" in line})
        self.assertEqual(blamed, wrong, found)


if __name__ == "__main__":
    unittest.main()
