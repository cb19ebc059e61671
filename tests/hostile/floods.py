"""Clients that flood gaitd: whatever they do, every e-stop of somebody else is acted on at once, and
ticks are in time.

floods.py FOLDER: the floods one after the other, each with 20 e-stops of a walking robot and 1000 of
one that has stopped. Prints a row for each flood beside one without. Then, in real time, commands that
cost a tick most.
"""
import json
import os
import random
import socket
import statistics
import subprocess
import sys
import time

from client import Client, Gaitd

STOPS = 20      # of a walking robot, for each flood
LATCHED = 1000  # of one that has stopped, for each flood
MAX_TICKS = 2
# Of them may take longer: the reader may lose its processor between reading and stopping, and ticks
# without a clock go on meanwhile, ten in a millisecond.
PREEMPTED = 2
MAX_MEDIAN = 5e-3  # s, from sending to the flag
LATE = 0.25         # of the ticks, beyond the share without a flood
COSTLY_TIME = 5.0   # s


def line(method, params=None):
    request = {'jsonrpc': '2.0', 'id': 1, 'method': method}
    if params is not None:
        request['params'] = params
    return json.dumps(request).encode() + b'\n'


# ---- Floods: each a function that goes on until it is killed.

def pipelined(path, data, read=True):
    client = Client(path, timeout=None)
    client.socket.setblocking(False)
    block = data * max(1, 65536 // len(data))
    rest = b''
    while True:
        if not rest:
            rest = block
        try:
            rest = rest[client.socket.send(rest):]
        except BlockingIOError:
            time.sleep(0.0005)
        except OSError:
            client = Client(path, timeout=None)
            client.socket.setblocking(False)
            rest = b''
        if not read:
            continue
        try:
            client.socket.recv(1 << 18)
        except OSError:
            pass


def idle(path, count):
    clients = []
    while True:
        if len(clients) < count:
            try:
                clients.append(Client(path))
                continue
            except OSError:
                pass
        time.sleep(0.01)
        for client in clients:
            client.socket.setblocking(False)
            try:
                if client.socket.recv(4096) == b'':
                    clients.remove(client)
                    break
            except OSError:
                pass


def reconnecting(path):
    while True:
        try:
            client = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            client.settimeout(1)
            client.connect(path)
            client.send(line('status')[:random.randrange(1, 40)])
            client.close()
        except OSError:
            time.sleep(0.001)


FLOODS = {
    'none': (0, None),
    'resume': (2, lambda path: pipelined(path, line('resume'))),
    'plugin.list': (10, lambda path: pipelined(path, line('plugin.list'))),
    'status unread': (4, lambda path: pipelined(path, line('status'), read=False)),
    'batches': (4, lambda path: pipelined(
        path, b'[' + b','.join([line('param.list').strip()] * 200) + b']\n')),
    'no JSON': (4, lambda path: pipelined(path, b'[' * 30 + b'1,' * 100000 + b'\n')),
    'nearly estop': (4, lambda path: pipelined(
        path, b'{"method": "status", "params": [' + b'"estop",' * 400 + b'1]}\n')),
    'as if estop': (4, lambda path: pipelined(
        path, b'{"method": "status", "params": [' + b'{"method": "estop"},' * 190 + b'1]}\n')),
    'idle': (1, lambda path: idle(path, 300)),
    'reconnecting': (4, reconnecting),
    'swaps': (2, lambda path: pipelined(
        path, line('plugin.swap', {'layer': 'icp_planner', 'to': 'no_such_variant'}))),
}


COSTLY = {
    'none': (0, None),
    'long walks': (2, lambda path: pipelined(
        path, line('walk', {'steps': 1000, 'length': 0.2}) + line('abort'))),
    'footsteps': (2, lambda path: pipelined(path, line('footsteps', {'replace': True, 'footsteps': [
        {'side': side, 'x': 0.0, 'y': y, 'contact_polygon': [
            [0.13, -0.064], [0.13, 0.064], [-0.13, 0.064], [-0.13, -0.064]]}
        for side, y in 32 * [('left', 0.12), ('right', -0.12)]]}))),
}


def start_flood(name, path):
    count, _ = {**FLOODS, **COSTLY}[name]
    return [subprocess.Popen([sys.executable, __file__, '--flood', name, path])
            for _ in range(count)]


# ---- The one who stops the robot.

def estop(path):
    """Connects, stops; the answer and the s from sending to the flag."""
    for _ in range(50):
        with Client(path) as client:
            sent = time.clock_gettime(time.CLOCK_MONOTONIC)
            try:
                answer = client.answer('estop')
            except ConnectionError:
                continue
        if 'error' in answer and answer['error']['code'] == -32002:
            time.sleep(0.002)
            continue
        if 'error' in answer:
            sys.exit(f'the e-stop was not acted on: {answer}')
        return answer['result'], answer['result']['raised_at'] - sent
    sys.exit('50 e-stops found no place')


def stop_walks(gaitd, operator):
    """Ticks from reading to acting, of every stop of a walking robot."""
    ticks = []
    for _ in range(STOPS):
        operator.ask('sim.reset')
        gaitd.wait('standing', operator)
        operator.ask('walk', {'steps': 20, 'length': 0.2})
        gaitd.wait('walking', operator)
        result, _ = estop(gaitd.path)
        status = operator.ask('status')
        if status['state'] != 'fault' or 'estop' not in status['faults']:
            sys.exit(f"after the e-stop: {status['state']} {status['faults']}")
        ticks.append(result['tick'] - result['read_at_tick'])
    return ticks


def stop_latched(path):
    return [estop(path)[1] for _ in range(LATCHED)]


def percentile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def stand_again(gaitd, operator):
    """Resets the robot until it stands: what a flood sent last may be read after the first reset."""
    for _ in range(10):
        operator.ask('sim.reset')
        try:
            return gaitd.wait('standing', operator, seconds=15)
        except RuntimeError as error:
            walks_on = error
    raise walks_on


def costly(folder):
    """What of the ticks is late while commands come that each look at many footsteps."""
    failed = []
    unflooded = 0.0
    with Gaitd(folder, '--clock', 'realtime', '--set', 'log.enabled=false') as gaitd:
        with gaitd.client() as operator:
            for name in COSTLY:
                stand_again(gaitd, operator)
                flood = start_flood(name, gaitd.path)
                time.sleep(0.5)
                try:
                    before = operator.ask('status')
                    time.sleep(COSTLY_TIME)
                    after = operator.ask('status')
                finally:
                    for one in flood:
                        one.kill()
                        one.wait()
                ticks, late = (after[key] - before[key] for key in ('tick', 'overruns'))
                share = late / max(1, ticks)
                print(f'{name:<15}{ticks:>6} ticks, {late} of them late', flush=True)
                if name == 'none':
                    unflooded = share
                elif share > unflooded + LATE:
                    failed.append(f'{name}: {late} of {ticks} ticks were late')
        if gaitd.stop() != 0:
            failed.append('gaitd ended badly: ' + gaitd.said())
    return failed


def run(folder):
    failed = []
    with Gaitd(folder, '--clock', 'lockstep', '--set', 'log.enabled=false') as gaitd:
        # Somebody who is connected already; the floods take what places there are.
        with gaitd.client() as operator:
            print(f"{'flood':<15}{'stops':>6}{'ticks, most':>13}{'flag median':>13}{'p99':>9}"
                  f"{'max':>9} ms")
            for name in FLOODS:
                flood = start_flood(name, gaitd.path)
                time.sleep(0.2)
                try:
                    ticks = stop_walks(gaitd, operator)
                    flags = stop_latched(gaitd.path)
                finally:
                    for one in flood:
                        one.kill()
                        one.wait()
                median = statistics.median(flags)
                print(f'{name:<15}{len(ticks):>6}{max(ticks):>13}{1e3 * median:>13.2f}'
                      f'{1e3 * percentile(flags, 0.99):>9.2f}{1e3 * max(flags):>9.2f}', flush=True)
                if len(ticks) != STOPS or sum(t > MAX_TICKS for t in ticks) > PREEMPTED:
                    failed.append(f'{name}: stops were acted on after {sorted(ticks)} ticks')
                if median > MAX_MEDIAN:
                    failed.append(f'{name}: half of the flags took more than {1e3 * median:.1f} ms')
        if gaitd.stop() != 0:
            failed.append('gaitd ended badly: ' + gaitd.said())
    failed += costly(folder)
    sys.exit('\n'.join(failed) or 0)


if __name__ == '__main__':
    if sys.argv[1] == '--flood':
        {**FLOODS, **COSTLY}[sys.argv[2]][1](sys.argv[3])
    run(sys.argv[1])
