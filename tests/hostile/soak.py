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
        self.steps = self.pushes = self.swaps = self.falls = self.refused = 0
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

    def command(self, client, method, params):
        """False if the robot cannot do that just now."""
        answer = client.answer(method, params)
        if 'error' not in answer:
            return True
        if answer['error']['code'] != -32000:
            raise RuntimeError(f"{method}: {answer['error']['message']}")
        self.refused += 1
        return False

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
        mode = self.random.choice(['walk-bent', 'walk-straight'])
        count = self.random.randint(6, 20)
        walk = {'steps': count, 'length': self.random.uniform(-0.1, 0.35),
                'turn': self.random.uniform(-0.1, 0.1)}
        if not (self.command(client, 'mode', {'mode': mode}) and self.command(client, 'walk', walk)):
            return
        self.steps += count
        for _ in range(self.random.randint(0, 3)):
            time.sleep(self.random.uniform(0.5, 2.0))
            if self.random.random() < 0.5:
                x, y = self.random.choice([(1, 0), (-1, 0), (0, 1), (0, -1)])
                push = {'link': 'utorso', 'duration': 0.1, 'force': [150.0 * x, 100.0 * y, 0.0]}
                self.pushes += self.command(client, 'sim.push', push)
            else:
                layer = self.random.choice(list(VARIANTS))
                self.swaps += self.command(client, 'plugin.swap', {
                    'layer': layer, 'to': self.random.choice(VARIANTS[layer])})


class Others(threading.Thread):
    """Somebody else's files: they fill the disk to its end, then they are gone again."""

    PAUSE, HOLD = 240.0, 20.0  # s
    RECOVERY = 15.0  # s, in which the log has to go on when there is room again

    def __init__(self, gaitd, disk):
        super().__init__(daemon=True)
        self.gaitd, self.disk = gaitd, disk
        self.done = threading.Event()
        self.fills = 0
        self.busy = False  # from the first byte until the log goes on
        self.problem = None

    def run(self):
        try:
            with self.gaitd.client('-observe') as client:
                while not self.done.wait(self.PAUSE):
                    state = os.statvfs(self.disk)
                    if state.f_blocks * state.f_frsize > 1 << 30:
                        return  # not a disk of our own
                    self.busy = True
                    self.fill(client)
                    self.busy = False
        except (OSError, RuntimeError) as error:
            if not self.done.is_set():
                self.problem = f'the disk was not filled and emptied: {error!r}'

    def fill(self, client):
        path = os.path.join(self.disk, 'others')
        end = time.monotonic() + self.HOLD
        with open(path, 'wb', buffering=0) as file:
            while time.monotonic() < end and not self.done.is_set():
                try:
                    file.write(b'\0' * (64 << 10))
                except OSError:
                    time.sleep(0.1)
        if client.ask('status')['log']['open']:
            self.problem = f'a disk that was full for {self.HOLD:.0f} s did not stop the log'
        os.unlink(path)
        self.fills += 1
        end = time.monotonic() + self.RECOVERY
        while not client.ask('status')['log']['open'] and not self.done.is_set():
            if time.monotonic() > end:
                self.problem = f'no log {self.RECOVERY:.0f} s after the disk had room again'
                return
            time.sleep(0.5)


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
    with Gaitd(folder, '--clock', 'realtime', '--set', 'log.max_size=20', '--set', 'log.keep=3',
               '--log', os.path.join(disk, 'soak.mcap')) as gaitd:
        gaitd.wait('standing')
        operator = Operator(gaitd)
        askers = [Asker(gaitd, seed) for seed in range(CLIENTS)]
        others = Others(gaitd, disk)
        threads = [operator, *askers, others]
        for thread in threads:
            thread.start()
        begin = time.monotonic()
        dropouts = fills = 0
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
                       'falls': operator.falls, 'refused': operator.refused,
                       'fills': others.fills, 'answers': sum(a.answers for a in askers)}
                print(' '.join(f'{k}={v:.0f}' for k, v in row.items()), flush=True)
                rows.append(row)
                problems += [t.problem for t in threads if t.problem]
                if row['dropouts'] > dropouts and not others.busy and others.fills == fills:
                    problems.append(f"{row['dropouts'] - dropouts} ticks were not logged")
                if not status['log']['open'] and not others.busy:
                    problems.append('there is no log: ' + status['log']['error'])
                dropouts, fills = row['dropouts'], others.fills
                if status['stale'] or problems:
                    break
        others.done.set()
        for thread in threads[:-1]:
            thread.done = True
        for thread in threads:
            thread.join(60)
        code = gaitd.stop()
        # 1: ticks were lost, as is meant when the disk is full.
        if code != (1 if others.fills else 0):
            problems.append(f'gaitd ended with {code}: {gaitd.said()}')
    gaitctl = os.path.join(os.environ['GAITD_BUILD'], 'bin', 'gaitctl')
    logs = [os.path.join(disk, name) for name in sorted(os.listdir(disk)) if name.endswith('.mcap')]
    codes = [subprocess.run([gaitctl, 'log', 'info', log], stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL).returncode for log in logs]
    cut_off = codes.count(4)  # by a full disk
    if not logs or cut_off > others.fills or any(code not in (0, 4) for code in codes):
        problems.append(f'logs that cannot be read: {dict(zip(logs, codes))}')
    warm = [row for row in rows if row['time'] > WARM_UP]
    print(f"{rows[-1]['time'] / 60:.0f} min, {rows[-1]['ticks']} ticks, longest answer "
          f"{1e3 * max(a.longest for a in askers):.0f} ms")
    for key, bound in BOUNDS.items():
        grown = slope(warm, key)
        print(f'{key}: {grown:+.1f} in an hour, at most {bound:.0f}')
        if len(warm) >= 10 and grown > bound:
            problems.append(f'{key} grows by {grown:.1f} in an hour')
    print(f"overruns {rows[-1]['overruns']}, dropouts {rows[-1]['dropouts']} with the disk full "
          f"{others.fills} times, falls {rows[-1]['falls']}")
    sys.exit('\n'.join(problems) or 0)


run(float(sys.argv[1]), sys.argv[2])
