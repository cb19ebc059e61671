"""gaitd over a disk that is frozen: frozen_disk.py walk DISK | stop DISK REPORT ROBOT_PID."""
import json
import os
import signal
import socket
import statistics
import subprocess
import sys
import threading
import time

FROZEN = 10.0  # s


def freeze(disk, on):
    subprocess.run(['fsfreeze', '-f' if on else '-u', disk], check=True)


class Manager:
    """What systemd would hear, and how long this machine keeps a thread waiting anyway."""

    def __init__(self):
        self.path = '/run/frozen-notify'
        if os.path.exists(self.path):
            os.unlink(self.path)
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.bind(self.path)
        self.fed = []
        self.probed = []
        for work in (self.listen, self.probe):
            threading.Thread(target=work, daemon=True).start()

    def listen(self):
        while True:
            if b'WATCHDOG=1' in self.socket.recv(4096):
                self.fed.append(time.monotonic())

    def probe(self):
        while True:
            self.probed.append(time.monotonic())
            time.sleep(0.05)

    @staticmethod
    def longest(times, begin, end):
        inside = [begin] + [t for t in times if begin <= t <= end] + [end]
        return max(b - a for a, b in zip(inside, inside[1:]))


class Refused(Exception):
    pass


class Gaitd:
    def __init__(self, disk, manager, clock, *arguments):
        self.path = '/run/frozen.sock'
        environment = dict(os.environ, NOTIFY_SOCKET=manager.path, WATCHDOG_USEC='1000000')
        self.process = subprocess.Popen(
            ['gaitd', '--clock', clock, '--socket', self.path, '--log', f'{disk}/log.mcap',
             *arguments], env=environment, stdout=open('/run/gaitd.txt', 'w'),
            stderr=subprocess.STDOUT)
        self.connection = None

    def ask(self, method, params=None):
        if self.connection is None:
            self.connection = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            self.connection.settimeout(60)
            self.connection.connect(self.path)
            self.file = self.connection.makefile('r')
        request = {'jsonrpc': '2.0', 'id': 1, 'method': method}
        if params:
            request['params'] = params
        self.connection.sendall(json.dumps(request).encode() + b'\n')
        answer = json.loads(self.file.readline())
        if 'error' in answer:
            raise Refused(f"{method}: {answer['error']['message']}")
        return answer['result']

    def arm(self, seconds=60):
        """Again while a robot that has just come up has not been estimated yet."""
        end = time.monotonic() + seconds
        while True:
            try:
                return self.ask('arm')
            except Refused as refusal:
                if 'no estimate yet' not in str(refusal) or time.monotonic() > end:
                    raise
            time.sleep(0.1)

    def wait(self, state, seconds=300):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if self.process.poll() is not None:
                sys.exit('gaitd ended: ' + open('/run/gaitd.txt').read()[-2000:])
            try:
                status = self.ask('status')
            except (FileNotFoundError, ConnectionError):
                self.connection = None
                time.sleep(0.2)
                continue
            if status['state'] == state:
                return status
            time.sleep(0.1)
        sys.exit(f"after {seconds} s not {state}: {status['state']} {status['faults']}")


def expect(true, what):
    if not true:
        sys.exit('expected ' + what)


def time_status(gaitd, times):
    asked = time.monotonic()
    status = gaitd.ask('status')
    times.append(time.monotonic() - asked)
    time.sleep(0.05)
    return status


def walk(disk):
    manager = Manager()
    gaitd = Gaitd(disk, manager, 'realtime')
    gaitd.wait('standing')
    gaitd.ask('walk', {'steps': 200, 'length': 0.2})
    gaitd.wait('walking')
    usual, times = [], []
    for _ in range(20):
        before = time_status(gaitd, usual)
    freeze(disk, True)
    begin = time.monotonic()
    stalled = 0.0
    while time.monotonic() < begin + FROZEN:
        status = time_status(gaitd, times)
        stalled = max(stalled, status['log']['stalled'])
        expect(status['state'] == 'walking', f'walking, got {status["state"]} {status["faults"]}')
        expect(not status['stale'], 'a status that is not stale')
    end = time.monotonic()
    median, before_median = statistics.median(times), statistics.median(usual)
    gap, probe = (Manager.longest(t, begin, end) for t in (manager.fed, manager.probed))
    print(f'frozen for {end - begin:.1f} s: {status["tick"] - before["tick"]} ticks; '
          f'status {1e3 * median:.1f} ms (median of {len(times)}), {1e3 * before_median:.1f} ms before; '
          f'longest gap of the watchdog {gap:.2f} s, of an idle thread {probe:.2f} s; '
          f'one operation of the disk took {stalled:.1f} s and more')
    expect(stalled > 1.0, 'a log that waits for the disk: this test freezes nothing')
    expect(status['tick'] > before['tick'] + 100, 'ticks while the disk is frozen')
    expect(median < max(0.1, 2 * before_median), 'the status within 0.1 s, or as soon as before')
    expect(gap < probe + 0.2, 'the watchdog fed')
    freeze(disk, False)
    # It goes on, and the log tells what it lacks.
    for _ in range(100):
        if gaitd.ask('status')['log']['stalled'] < 1.0:
            break
        time.sleep(0.1)
    gaitd.process.send_signal(signal.SIGTERM)
    expect(gaitd.process.wait(120) == 0, 'exit code 0: ' + open('/run/gaitd.txt').read()[-2000:])


def stop(disk, report, robot):
    manager = Manager()
    # In lockstep, for real time means little in here: the loop itself waits for the disk then, too.
    gaitd = Gaitd(disk, manager, 'lockstep', '--backend', 'socketcan', '--set', 'can=can-classic.yaml',
                  '--set', 'period=0.01', '--set', 'socketcan.lockstep_timeout=30',
                  '--set', 'safety.ready_duration=60', '--set', 'safety.sensor_timeout=1')
    gaitd.wait('disarmed')
    for _ in range(600):
        health = gaitd.ask('status')['health']
        if health and health['healthy']:
            break
        time.sleep(0.1)
    gaitd.arm()
    gaitd.wait('readying')
    freeze(disk, True)
    begin = time.monotonic()
    while gaitd.ask('status')['log']['stalled'] < 1.0:
        expect(time.monotonic() < begin + 60, 'a log that waits for the disk')
        time.sleep(0.1)
    gaitd.process.send_signal(signal.SIGTERM)
    # The robot hears that it is over while gaitd still waits for its disk.
    time.sleep(3.0)
    expect(gaitd.process.poll() is None, 'a gaitd that still waits for the disk')
    os.kill(int(robot), signal.SIGTERM)
    for _ in range(600):
        if os.path.exists(report) and os.path.getsize(report) > 0:
            break
        time.sleep(0.1)
    time.sleep(0.5)
    with open(report, encoding='utf-8') as file:
        motors = json.load(file)['motors']
    print(f'SIGTERM over a frozen disk: {motors}')
    expect(motors['off'] == 30, 'all motors off before the log is complete')
    freeze(disk, False)
    gaitd.process.wait(120)


if sys.argv[1] == 'walk':
    walk(sys.argv[2])
else:
    stop(*sys.argv[2:])
