#!/usr/bin/python3
"""How fast the Python package opens a long log: run with PYTHONPATH=build/release/python.

  benchmarks/python_log.py LOG.mcap     a log that exists
  benchmarks/python_log.py --make FILE  plays ten minutes of walking into FILE first; a few minutes, 1.7 GB

Every figure comes from a process of its own: time of opening, of one signal as numpy, peak memory with everything that
is imported. The columns that stand beside the log are deleted at the beginning.
"""

import json
import os
import subprocess
import sys

SCENARIO = {
    "name": "ten-minutes",
    "robot": "atlas",
    "duration": 602,
    "seed": 1,
    "mode": "walk-straight",
    "sensors": {"noise": "nominal"},
    "actuators": {"model": "ideal"},
    "commands": [{"at": 2.5, "walk": {"steps": 700, "length": 0.35, "swing": 0.6, "transfer": 0.25}}],
    "expect": {"no_fall": True},
}
PROBE = """
import json, resource, sys, time
start = time.perf_counter()
import gaitd, numpy
imported = time.perf_counter()
log = gaitd.Log(sys.argv[1])
opened, processor = time.perf_counter(), time.process_time()
log["icp/x"]
signal = time.perf_counter()
print(json.dumps({"import": imported - start, "open": opened - imported, "processor": processor, "signal": signal - opened,
                  "MB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3, "ticks": log.ticks,
                  "anew": log._native.read_anew}))
"""


def probe(path):
    done = subprocess.run([sys.executable, "-c", PROBE, path], check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout)


def tell(name, figures):
    print(f"{name}: open {figures['open']:.3f} s, one signal {figures['signal']:.3f} s, {figures['MB']:.0f} MB")


def main():
    arguments = sys.argv[1:]
    if arguments[:1] == ["--make"]:
        import gaitd

        arguments = [gaitd.run(SCENARIO, log=arguments[1]).log_file]
    if len(arguments) != 1:
        sys.exit(__doc__)
    path = arguments[0]
    columns = path + ".columns"
    if os.path.exists(columns):
        os.unlink(columns)
    size = os.path.getsize(path) / 1e6
    first = probe(path)
    tell("first", first)
    print(f"first read: {size:.0f} MB of log at {size / first['open']:.0f} MB/s; {size / first['processor']:.0f} MB per second "
          f"of processor; {os.path.getsize(columns) / 1e6:.0f} MB of columns for {first['ticks']} ticks")  # fmt: skip
    again = [probe(path) for _ in range(5)]
    assert first["anew"] and not any(one["anew"] for one in again)
    tell("again, the slowest of five", {key: max(one[key] for one in again) for key in again[0]})


if __name__ == "__main__":
    main()
