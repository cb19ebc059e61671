"""soak.py HOURS FOLDER: see tests/soak.sh."""
import os
import random
import statistics
import subprocess
import sys
import threading
import time

from client import Client, Gaitd

WARM_UP = 300.0  # s, in which memory may grow
CLIENTS = 10
# Growth over an hour beyond which something leaks.
BOUNDS = {'rss_kb': 4096.0, 'descriptors': 1.0, 'maps': 12.0, 'threads': 1.0}
VARIANTS = {'icp_planner': ['heel_to_toe', 'single_cmp'], 'toe_off': ['icp_criteria', 'never']}


class Asker(threading.Thread):
    """A client that asks for something all the time; now and then it leaves, politely or not."""

    def __init__(self, gaitd, seed):
        super().__init__(daemon=True)
        self.gaitd = gaitd
        self.random = random.Random(seed)
        self.answers = 0
        self.longest = 0.0
        self.done = False
        self.problem = None

    def run(self):
        client = self.gaitd.client(self.random.choice(['', '-observe', '-admin']))
        while not self.done:
            try:
                begin = time.monotonic()
                client.ask(self.random.choice(['status', 'status', 'status', 'param.list',
                                               'plugin.list', 'version', 'joint.list']))
                self.longest = max(self.longest, time.monotonic() - begin)
                self.answers += 1
                if self.random.random() < 0.01:
                    if self.random.random() < 0.5:
                        client.send(b'{"half a line')
                    client.close()
                    client = self.gaitd.client()
            except (OSError, RuntimeError) as error:
                if not self.done:
                    self.problem = f'a client was not served: {error!r}'
                return
            time.sleep(self.random.uniform(0.0, 0.1))


class Operator(threading.Thread):
    """Walks, pushes, swaps, and helps the robot up when it has fallen."""

    def __init__(self, gaitd):
        super().__init__(daemon=True)
        self.gaitd = gaitd
        self.random = random.Random(1)
        self.steps = self.pushes = self.swaps = self.falls = 0
        self.done = False
        self.problem = None

    def run(self):
        try:
            with self.gaitd.client() as client:
                while not self.done:
                    self.walk(client)
        except (OSError, RuntimeError) as error:
            if not self.done:
                self.problem = f'the operator was not served: {error!r}'

    def walk(self, client):
        status = client.ask('status')
        if status['state'] == 'fault':
            self.falls += 1
            client.ask('sim.reset')
            return
        if status['state'] != 'standing':
            time.sleep(0.1)
            return
        if abs(status['pelvis']['x']) > 20.0 or abs(status['pelvis']['y']) > 20.0:
            client.ask('sim.reset')
            return
        client.ask('mode', {'mode': self.random.choice(['walk-bent', 'walk-straight'])})
        count = self.random.randint(6, 20)
        client.ask('walk', {'steps': count, 'length': self.random.uniform(-0.1, 0.35),
                            'turn': self.random.uniform(-0.1, 0.1)})
        self.steps += count
        for _ in range(self.random.randint(0, 3)):
            time.sleep(self.random.uniform(0.5, 2.0))
            if self.random.random() < 0.5:
                angle = self.random.choice([[1, 0], [-1, 0], [0, 1], [0, -1]])
                client.ask('sim.push', {'link': 'utorso', 'duration': 0.1,
                                        'force': [150.0 * angle[0], 100.0 * angle[1], 0.0]})
                self.pushes += 1
            else:
                layer = self.random.choice(list(VARIANTS))
                answer = client.answer('plugin.swap', {
                    'layer': layer, 'to': self.random.choice(VARIANTS[layer])})
                self.swaps += 'result' in answer


def fill_and_empty(disk, done):
    """Somebody else's files: nearly all of the disk, then nothing again."""
    path = os.path.join(disk, 'others')
    while not done.wait(60.0):
        state = os.statvfs(disk)
        free = state.f_bavail * state.f_frsize
        if free > 1 << 30:
            return  # not a disk of our own
        with open(path, 'wb') as file:
            file.write(b'\0' * max(0, free - (40 << 20)))
        if done.wait(20.0):
            return
        os.unlink(path)


def measure(process):
    base = f'/proc/{process.pid}'
    with open(f'{base}/status', encoding='utf-8') as file:
        status = dict(line.split(':', 1) for line in file)
    with open(f'{base}/maps', encoding='utf-8') as file:
        maps = sum(1 for _ in file)
    return {'rss_kb': float(status['VmRSS'].split()[0]), 'threads': float(status['Threads']),
            'descriptors': float(len(os.listdir(f'{base}/fd'))), 'maps': float(maps)}


def slope(rows, key):
    """Growth in an hour, by the median of the slopes between all pairs of minutes."""
    slopes = [(b[key] - a[key]) / (b['time'] - a['time'])
              for i, a in enumerate(rows) for b in rows[i + 1:]]
    return 3600.0 * statistics.median(slopes) if slopes else 0.0


def run(hours, folder):
    disk = os.path.join(folder, 'disk')
    problems = []
    rows = []
    done = threading.Event()
    with Gaitd(folder, '--clock', 'realtime', '--set', 'log.max_size=20', '--set', 'log.keep=3',
               '--log', os.path.join(disk, 'soak.mcap')) as gaitd:
        gaitd.wait('standing')
        operator = Operator(gaitd)
        askers = [Asker(gaitd, seed) for seed in range(CLIENTS)]
        threads = [operator, *askers]
        for thread in threads:
            thread.start()
        threading.Thread(target=fill_and_empty, args=(disk, done), daemon=True).start()
        begin = time.monotonic()
        with gaitd.client('-observe') as watcher:
            while time.monotonic() - begin < 3600.0 * hours:
                time.sleep(min(60.0, max(1.0, 3600.0 * hours - (time.monotonic() - begin))))
                if gaitd.process.poll() is not None:
                    sys.exit(f'gaitd ended with {gaitd.process.returncode}: {gaitd.said()}')
                status = watcher.ask('status')
                row = {'time': time.monotonic() - begin, **measure(gaitd.process),
                       'ticks': status['tick'], 'overruns': status['overruns'],
                       'dropouts': status['log']['dropouts'], 'part': status['log']['part'],
                       'steps': operator.steps, 'pushes': operator.pushes, 'swaps': operator.swaps,
                       'falls': operator.falls, 'answers': sum(a.answers for a in askers)}
                print(' '.join(f'{k}={v:.0f}' for k, v in row.items()), flush=True)
                rows.append(row)
                problems += [t.problem for t in threads if t.problem]
                if status['log']['error']:
                    problems.append('the log ended: ' + status['log']['error'])
                if status['stale'] or problems:
                    break
        done.set()
        for thread in threads:
            thread.done = True
        for thread in threads:
            thread.join(60)
        code = gaitd.stop()
        if code != 0:
            problems.append(f'gaitd ended with {code}: {gaitd.said()}')
    gaitctl = os.path.join(os.environ['GAITD_BUILD'], 'bin', 'gaitctl')
    for log in sorted(os.listdir(disk)):
        if log.endswith('.mcap') and subprocess.run(
                [gaitctl, 'log', 'info', os.path.join(disk, log)], stdout=subprocess.DEVNULL).returncode:
            problems.append(f'{log} is not complete')
    warm = [row for row in rows if row['time'] > WARM_UP]
    print(f"{rows[-1]['time'] / 60:.0f} min, {rows[-1]['ticks']} ticks, longest answer "
          f"{1e3 * max(a.longest for a in askers):.0f} ms")
    for key, bound in BOUNDS.items():
        grown = slope(warm, key)
        print(f'{key}: {grown:+.1f} in an hour, at most {bound:.0f}')
        if len(warm) >= 10 and grown > bound:
            problems.append(f'{key} grows by {grown:.1f} in an hour')
    print(f"overruns {rows[-1]['overruns']}, dropouts {rows[-1]['dropouts']}, "
          f"falls {rows[-1]['falls']}")
    if rows[-1]['dropouts']:
        problems.append(f"{rows[-1]['dropouts']} ticks were not logged")
    sys.exit('\n'.join(problems) or 0)


run(float(sys.argv[1]), sys.argv[2])
