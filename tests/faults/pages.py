"""The messages of a page to `interplay play`, over its socket on this machine."""

import base64
import contextlib
import json
import os
import pathlib
import random
import signal
import socket
import struct
import subprocess
import time

import plays
from target import Target

STARTS = ["lane-change/front-nice", "intersection/nice", "people/high-street", "building/four-room-pid", "nowhere", "", "../x", "\u009b31m"]
PATIENCE_S = 10.0
LAST = '{"type": "echo", "at": 424242}'


def _message(dice: random.Random) -> str:
    others = [{"type": "start", "scenario": dice.choice(STARTS), "seat": dice.choice(["ego", "front", "x", ""])}, {"type": "next"}, {"type": "menu"}]
    others += [{"type": "seat", "seat": dice.choice(["front", "rear", "x"])}, {"type": "end"}, {"type": "agree"}, {"type": "leave"}]
    said = json.dumps(dice.choice(others) if dice.random() < 0.35 else plays.message(dice))
    return plays.spoilt_line(said, dice) if dice.random() < 0.3 else said


def _spoil(text: str, _others: list[str], dice: random.Random) -> str:
    scenario, seat, *messages = json.loads(text)
    if dice.random() < 0.7:
        scenario, seat, messages = dice.choice(STARTS[:3]), "ego", []
    messages += [_message(dice) for _ in range(dice.randint(1, 8))]
    if dice.random() < 0.15:
        # A frame that is not text, or no frame at all.
        messages.append(dice.choice(["frame:8200", "frame:0180000000", "frame:c18000000000", "frame:81ff7fffffffffffffff", "frame:888200000000ffff", "frame:8980", "frame:f100"]))
    return json.dumps([scenario, seat, *messages])


def _frame(text: str) -> bytes:
    """A frame of a browser."""
    if text.startswith("frame:"):
        return bytes.fromhex(text[6:])
    content, mask = text.encode("utf-8", "surrogatepass"), os.urandom(4)
    size = len(content)
    head = struct.pack("!BB", 0x81, 0x80 | size) if size < 126 else struct.pack("!BBH", 0x81, 0xFE, size)
    return head + mask + bytes(byte ^ mask[at % 4] for at, byte in enumerate(content))


def _connected(address: str) -> socket.socket:
    """A socket of a page."""
    host, _, token = address.removeprefix("http://").strip("/").partition("/")
    name, _, port = host.partition(":")
    page = socket.create_connection((name, int(port)), timeout=PATIENCE_S)
    key = base64.b64encode(os.urandom(16)).decode()
    lines = [f"GET /{token}/socket HTTP/1.1", f"Host: {host}", f"Origin: http://{host}", "Upgrade: websocket", "Connection: Upgrade"]
    page.sendall("\r\n".join([*lines, f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13", "", ""]).encode())
    said = b""
    while not said.endswith(b"\r\n\r\n"):
        said += page.recv(1) or b"\r\n\r\n"
    return page


def _heard(page: socket.socket, wanted: bytes) -> bool:
    """Whether a text comes before the server is silent or gone."""
    end, said = time.monotonic() + PATIENCE_S, b""
    with contextlib.suppress(OSError):
        while time.monotonic() < end:
            more = page.recv(65536)
            if not more:
                return False
            said = (said + more)[-200_000:]
            if wanted in said:
                return True
    return False


def _told(address: str, messages: list[str]) -> str | None:
    """Tells the server everything; what is wrong with it then, if anything."""
    with contextlib.suppress(OSError), _connected(address) as page:
        for message in messages:
            page.sendall(_frame(message))
            time.sleep(0.03)
    # Another page must be served after that.
    try:
        with _connected(address) as page:
            page.sendall(_frame(LAST))
            return None if _heard(page, b"424242") else "the server no longer answers"
    except OSError as error:
        return f"the server is gone: {error}"


def _attempt(binary: str, folder: pathlib.Path, text: str) -> tuple[str, str, str | None]:
    """Serves, tells, and ends the server: its exit code, what it said, and what was wrong."""
    scenario, seat, *messages = json.loads(text)
    words = [binary, "play", scenario, "--as", seat, "--no-browser"]
    with subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as server:
        address = server.stdout.readline().decode().strip()
        fault = _told(address, messages) if address.startswith("http") else None
        server.send_signal(signal.SIGINT)
        try:
            out, errors = server.communicate(timeout=30)
        except subprocess.TimeoutExpired:
            server.kill()
            return "hang", "", "it does not end at Ctrl-C"
    said = (out + errors).decode("utf-8", "replace")
    code = server.returncode
    ended = str(code) if code in (0, 1, 2, 3) else "0" if code == -signal.SIGINT else f"crash {code}"
    return ended, said, fault or _kept(binary, folder)


def _kept(binary: str, folder: pathlib.Path) -> str | None:
    """Whether what was kept is refused."""
    for file in sorted(folder.glob("played/*.toml")):
        done = subprocess.run([binary, "check", file], cwd=folder, capture_output=True, timeout=60)
        if done.returncode:
            return f"what was kept is refused: {done.stderr.decode('utf-8', 'replace')[:600]}"
    return None


def targets(_binary: str) -> dict[str, Target]:
    """The socket."""
    seeds = [json.dumps([scenario, "ego", LAST]) for scenario in STARTS[:3]]
    return {"page": Target("json", seeds, _spoil, lambda _: ([], []), own=_attempt)}
