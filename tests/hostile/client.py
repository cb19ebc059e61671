"""A client that sends whatever a test wants, and a gaitd of the test's own."""
import json
import os
import signal
import socket
import subprocess
import time


class Client:
    """One connection; `ask` raises what gaitd answers with an error."""

    def __init__(self, path, timeout=20.0):
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.socket.connect(path)  # waits while many others knock
        self.socket.settimeout(timeout)
        self.buffer = b''

    def send(self, data):
        self.socket.sendall(data)

    def line(self):
        while b'\n' not in self.buffer:
            data = self.socket.recv(1 << 16)
            if not data:
                raise ConnectionError('gaitd closed the connection')
            self.buffer += data
        line, self.buffer = self.buffer.split(b'\n', 1)
        return json.loads(line)

    def answer(self, method, params=None):
        request = {'jsonrpc': '2.0', 'id': 1, 'method': method}
        if params is not None:
            request['params'] = params
        self.send(json.dumps(request).encode() + b'\n')
        return self.line()

    def ask(self, method, params=None):
        answer = self.answer(method, params)
        if 'error' in answer:
            raise RuntimeError(f"{method}: {answer['error']['message']}")
        return answer['result']

    def close(self):
        self.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class Gaitd:
    """A gaitd on a socket in `folder`, ended with the test."""

    def __init__(self, folder, *arguments):
        self.path = os.path.join(folder, 'gaitd.sock')
        self.output = os.path.join(folder, 'gaitd.txt')
        program = os.path.join(os.environ['GAITD_BUILD'], 'bin', 'gaitd')
        self.process = subprocess.Popen(
            [program, '--socket', self.path, *arguments],
            stdin=subprocess.DEVNULL, stdout=open(self.output, 'w'), stderr=subprocess.STDOUT)
        for _ in range(1200):
            if self.process.poll() is not None:
                raise RuntimeError('gaitd ended: ' + self.said())
            try:
                Client(self.path).close()
                return
            except OSError:
                time.sleep(0.05)
        raise RuntimeError('gaitd does not listen: ' + self.said())

    def said(self):
        with open(self.output, encoding='utf-8', errors='replace') as file:
            return file.read()[-4000:]

    def client(self, role=''):
        return Client(self.path.replace('gaitd.sock', f'gaitd{role}.sock'))

    def wait(self, state, client=None, seconds=120):
        """Until the robot is in `state`; the status."""
        own = client or self.client()
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            status = own.ask('status')
            if status['state'] == state:
                if client is None:
                    own.close()
                return status
            time.sleep(0.005)
        raise RuntimeError(f"after {seconds} s not {state}: {status['state']} {status['faults']}")

    def stop(self, signal_number=signal.SIGTERM, seconds=60):
        """Its exit code."""
        self.process.send_signal(signal_number)
        return self.process.wait(seconds)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
