"""The server of `benches.py`: a house with a heat pump that answers as BOPTEST does, but for its lies."""

import contextlib
import json
import math
import socketserver
import threading
import time
from collections import Counter
from collections.abc import Iterator

KELVIN = 273.15
LATE_S = 1.3
MEASURED = ["reaTZon_y", "reaCO2RooAir_y", "reaPHeaPum_y", "reaPFan_y"]
MARK = "\x01"


class House:
    """An honest house, one at a time."""

    def __init__(self) -> None:
        self.step_s, self.time_s, self.zone_k, self.power_w = 1800.0, 0.0, 293.15, 0.0
        self.results: list[dict[str, float]] = []

    def measurements(self) -> dict[str, float]:
        found = {"time": self.time_s, "reaTZon_y": self.zone_k, "reaCO2RooAir_y": 600.0, "reaPHeaPum_y": self.power_w, "reaPFan_y": 10.0}
        self.results.append(found)
        return found

    def advance(self, body: dict) -> dict[str, float]:
        share = float(body.get("oveHeaPumY_u") or 0.0)
        outdoor_k = KELVIN + 2.0 + 4.0 * math.sin(2 * math.pi * self.time_s / 86400)
        flow_kw = (outdoor_k - self.zone_k) / 4.2 + 11.0 * share
        self.zone_k += flow_kw * self.step_s / 60000.0
        self.power_w, self.time_s = 3500.0 * share, self.time_s + self.step_s
        return self.measurements()

    def forecast(self, body: dict) -> dict[str, list[float]]:
        times = [index * float(body["interval"]) for index in range(int(body["horizon"] / body["interval"]) + 1)]
        return {"time": times} | {name: [_foretold(name, time_s) for time_s in times] for name in body["point_names"]}

    def answer(self, asked: str, body: dict) -> object:
        match asked:
            case "inputs":
                return {"oveHeaPumY_u": {"Unit": "1"}, "oveHeaPumY_activate": {"Unit": None}}
            case "measurements":
                return {name: {"Unit": "K"} for name in MEASURED}
            case "step":
                self.step_s = float(body["step"])
                return {"step": self.step_s}
            case "scenario":
                return {"electricity_price": "dynamic"} | ({"time_period": self.measurements()} if "time_period" in body else {})
            case "initialize":
                self.time_s = float(body["start_time"])
                return self.measurements()
            case "forecast":
                return self.forecast(body)
            case "advance":
                return self.advance(body)
            case "results":
                names = ["time", *body["point_names"]]
                rows = [row for row in self.results if body["start_time"] <= row["time"] <= body["final_time"]]
                return {name: [row[name] for row in rows] for name in names}
            case "kpi":
                return {"tdis_tot": 1.0, "ener_tot": 2.0, "cost_tot": 0.5, "emis_tot": 0.3, "pele_tot": 0.02, "pgas_tot": None, "time_rat": 1e-3}
            case "select":
                return {"testid": "a-1"}
        return {}


def _foretold(name: str, time_s: float) -> float:
    hour = time_s / 3600 % 24
    if name.startswith(("LowerSetp", "UpperSetp")):
        return KELVIN + (21.0 if 7 <= hour < 20 else 15.0) + (3.0 if name.startswith("Upper") else 0.0)
    known = {"TDryBul": KELVIN + 2.0, "HGloHor": max(0.0, 300 * math.sin(math.pi * (hour - 6) / 12)), "UpperCO2[1]": 900.0}
    return known.get(name, 0.1 + 0.2 * (hour > 12))


def _leaves(value: object, path: tuple = ()) -> list[tuple]:
    """The paths of all values that are no containers."""
    if isinstance(value, dict):
        return [leaf for key, inner in value.items() for leaf in _leaves(inner, (*path, key))] or [path]
    if isinstance(value, list):
        return [leaf for key, inner in enumerate(value) for leaf in _leaves(inner, (*path, key))] or [path]
    return [path]


def _edited(value: object, lie: dict) -> object:
    """An answer with a lie in it; a mark stands for text that is not JSON."""
    if lie["kind"] == "extra" and isinstance(value, dict):
        return value | {"\u009b31m": 1, "time ": [1], "": {}}
    leaves = _leaves(value)
    path = leaves[int(lie["where"] * len(leaves))]
    if not path:
        return MARK
    holder = value
    for key in path[:-1]:
        holder = holder[key]
    last = path[-1]
    match lie["kind"]:
        case "drop":
            del holder[last]
        case "series" if isinstance(holder, list):
            holder[:] = [MARK] * len(holder)
        case "scaled" if isinstance(holder, list):
            holder[:] = [number * lie["factor"] if isinstance(number, float) else number for number in holder]
        case "scaled" if isinstance(holder[last], float):
            holder[last] *= lie["factor"]
        case "shorter" if isinstance(holder, list):
            del holder[last:]
        case "longer" if isinstance(holder, list):
            holder += holder[:3]
        case _:
            holder[last] = MARK
    return value


def _on_the_wire(body: bytes, lie: dict) -> bytes | None:
    """The bytes that are sent in place of an honest answer; none closes the connection."""
    at, token = int(lie["where"] * len(body)), str(lie["token"]).encode("utf-8")
    head = b"HTTP/1.1 200 OK\r\nContent-Type: application/json\r\n"
    length = b"Content-Length: %d\r\n\r\n"
    match lie["kind"]:
        case "status":
            return b"HTTP/1.1 500 \xc2\x9b31m no\r\n" + length % len(token) + token
        case "stated":
            said = b'{"status":400,"message":"\\u009b31m\\u0007","payload":' + body + b"}"
            return head + length % len(said) + said
        case "cut":
            return head + length % len(body) + body[:at]
        case "raw":
            said = body[:at] + token + body[at + 3 :]
            return head + length % len(said) + said
        case "length":
            return head + b"Content-Length: " + token + b"\r\n\r\n" + body
        case "header":
            return token + head + b"\xff\xfe: \x9b\r\n" + length % len(body) + body
        case "chunked":
            return head + b"Transfer-Encoding: chunked\r\n\r\n5\r\n" + body[:5] + b"\r\n0\r\n\r\n"
        case "empty":
            return head + length % 0
    return None


class _Server(socketserver.ThreadingTCPServer):
    daemon_threads, allow_reuse_address = True, True

    def __init__(self, lies: list[dict]) -> None:
        super().__init__(("127.0.0.1", 0), _Handler)
        self.lies, self.house, self.counts, self.lock = lies, House(), Counter(), threading.Lock()


class _Handler(socketserver.StreamRequestHandler):
    def handle(self) -> None:
        with contextlib.suppress(OSError):
            self._handle()

    def _handle(self) -> None:
        words = self.rfile.readline().decode("latin-1").split()
        length = 0
        while line := self.rfile.readline().strip():
            name, _, value = line.partition(b":")
            length = int(value) if name.lower() == b"content-length" else length
        body = json.loads(self.rfile.read(length) or b"{}")
        parts = (words[1] if len(words) > 1 else "/").strip("/").split("/")
        asked = "select" if parts[-1] == "select" else parts[0]
        with self.server.lock:
            said = self._answer(asked, body)
        if said is not None:
            self.wfile.write(said)

    def _answer(self, asked: str, body: dict) -> bytes | None:
        server = self.server
        if asked in ("scenario", "initialize"):
            server.house.results.clear()
        answer = json.loads(json.dumps(server.house.answer(asked, body)))
        nth, token = server.counts[asked], "null"
        server.counts[asked] += 1
        lies = [lie for lie in server.lies if lie["at"] == asked and lie.get("nth", nth) == nth]
        for lie in lies:
            if lie["kind"] in ("value", "drop", "series", "scaled", "shorter", "longer", "extra"):
                answer, token = _edited(answer, lie), lie["token"]
        if asked == "select":
            text = json.dumps(answer)
        else:
            text = json.dumps({"status": 200, "message": "", "payload": answer})
        text = text.replace(json.dumps(MARK), token)
        for lie in lies:
            if lie["kind"] == "late":
                time.sleep(LATE_S)
            elif lie["kind"] in ("status", "stated", "cut", "raw", "length", "header", "chunked", "empty", "close"):
                return _on_the_wire(text.encode("utf-8", "surrogateescape"), lie)
        said = text.encode("utf-8", "surrogateescape")
        return b"HTTP/1.1 200 OK\r\nContent-Length: %d\r\n\r\n" % len(said) + said


@contextlib.contextmanager
def serving(lies: list[dict]) -> Iterator[int]:
    """The port of a server that tells these lies."""
    with _Server(lies) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True)
        thread.start()
        try:
            yield server.server_address[1]
        finally:
            server.shutdown()
            thread.join()
