# SPDX-License-Identifier: Apache-2.0
"""`gaitctl view` away from this machine: TLS with the printed fingerprint, and nothing without it.
view_tls.py ADDRESSES: the file into which `gaitctl --json view --listen [::]:0` has printed them."""
import hashlib
import json
import os
import re
import socket
import ssl
import sys
import time
import warnings

pages = json.load(open(sys.argv[1]))
host, port, token = re.match(r"https://([^/]+):(\d+)/#token=([0-9a-f]{32})$", pages["observe"]).groups()


def check(holds, what):
    if not holds:
        sys.exit(f"FAILED: {what}")


check(host not in ("[::]", "0.0.0.0"), f"no browser finds {host}")
anyone = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)  # whose certificate is then compared, as people do
anyone.check_hostname = False
anyone.verify_mode = ssl.CERT_NONE


def connect(context=anyone, address="127.0.0.1"):
    return context.wrap_socket(socket.create_connection((address, int(port)), 10), server_hostname="localhost")


def ask(connection, lines):
    connection.sendall("".join(line + "\r\n" for line in lines + [""]).encode())
    data = b""
    while part := connection.recv(65536):
        data += part
        if b"\r\n\r\n" in data and (b" 101 " in data or b"</html>" in data):
            break
    return data


for address in ["127.0.0.1", "::1"]:
    with connect(address=address) as secure:
        digest = hashlib.sha256(secure.getpeercert(True)).hexdigest().upper()
        shown = pages["fingerprint"].replace(":", "")
        check(digest == shown, f"the certificate has {digest}, printed was {shown}")
        check(secure.version() in ("TLSv1.2", "TLSv1.3"), secure.version())
        body = ask(secure, ["GET / HTTP/1.1", f"Host: {host}:{port}", "Connection: close"])
        check(b" 200 " in body[:20] and b"<html" in body, f"the page over TLS: {body[:80]}")
with connect() as secure:
    answer = ask(secure, ["GET /live HTTP/1.1", f"Host: {host}:{port}", f"Origin: https://{host}:{port}",
                          "Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13",
                          "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==",
                          f"Sec-WebSocket-Protocol: gaitd.v1, token.{token}"])
    check(b" 101 " in answer[:20], f"the WebSocket over TLS: {answer[:80]}")
with connect() as secure:
    answer = ask(secure, ["GET /live HTTP/1.1", f"Host: {host}:{port}", f"Origin: http://{host}:{port}",
                          "Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13",
                          "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==", "Connection: close",
                          f"Sec-WebSocket-Protocol: gaitd.v1, token.{token}"])
    check(b" 101 " not in answer[:20], "a page without TLS may connect")

# Not signed by anybody that this machine trusts, and no old TLS.
try:
    connect(ssl.create_default_context())
    sys.exit("FAILED: a certificate that nobody has signed is trusted")
except ssl.SSLCertVerificationError:
    pass
warnings.simplefilter("ignore", DeprecationWarning)  # that is the point of it
old = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
old.check_hostname = False
old.verify_mode = ssl.CERT_NONE
old.minimum_version = ssl.TLSVersion.TLSv1
old.maximum_version = ssl.TLSVersion.TLSv1_1
old.set_ciphers("ALL:@SECLEVEL=0")
try:
    connect(old)
    sys.exit("FAILED: TLS 1.1 is spoken")
except (ssl.SSLError, ConnectionError):
    pass

# Plain HTTP gets nothing; handshakes that stop half-way keep nobody out.
half = [socket.create_connection(("127.0.0.1", int(port))) for _ in range(30)]
for connection in half[:15]:
    connection.sendall(b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc")
with socket.create_connection(("127.0.0.1", int(port)), 10) as plain:
    plain.sendall(f"GET / HTTP/1.1\r\nHost: {host}:{port}\r\n\r\n".encode())
    answer = b""
    try:
        while part := plain.recv(65536):
            answer += part
    except ConnectionError:
        pass
    check(b"HTTP/" not in answer and b"html" not in answer, f"plain HTTP: {answer[:80]}")
begin = time.monotonic()
connect().close()
check(time.monotonic() - begin < 5, "a handshake beside those that stop half-way")

file = os.environ["HOME"] + "/.config/gaitd/view.pem"
mode = os.stat(file).st_mode & 0o777
check(mode == 0o600, f"{file} has the mode {mode:o}")
print(pages["fingerprint"])
