"""The other side of `building.plant = { kind = "socket" }`: answers the lines of a run (docs/guide/foreign-plants.md).

`serve` takes a listening socket and a function that makes a plant of the `start` message. A plant is an object with

    temperatures_c()    the temperatures of the zones [°C]
    step(message)       moves on by a step with the heat in `message`
    close()             ends
"""

import json
import socket

PROTOCOL = 1


def listen(port, host="127.0.0.1"):
    """A socket that listens; port 0 is any that is free."""
    return socket.create_server((host, port))


def serve(make_plant, server, runs=None):
    """Answers `runs` runs, one after the other; without a number, until it is interrupted. Closes the socket."""
    with server:
        served = 0
        while runs is None or served < runs:
            connection, _ = server.accept()
            with connection, connection.makefile("rw", encoding="utf-8", newline="\n") as lines:
                try:
                    _serve_run(make_plant, lines)
                except (BrokenPipeError, ConnectionResetError):
                    print("the run ended without saying so", flush=True)
            served += 1


def _serve_run(make_plant, lines):
    plant = None

    def answer(message):
        lines.write(json.dumps(message, allow_nan=False) + "\n")
        lines.flush()

    try:
        for line in lines:
            message = json.loads(line)
            kind = message["message"]
            if kind == "start":
                plant = make_plant(message)
                answer({"message": "ready", "protocol": PROTOCOL, "temperatures_c": plant.temperatures_c()})
            elif kind == "step":
                plant.step(message)
                answer({"message": "state", "step": message["step"], "temperatures_c": plant.temperatures_c()})
            elif kind == "end":
                return
    except (BrokenPipeError, ConnectionResetError):
        raise
    except Exception as error:  # Any failure here is sent to the run, which ends with it.
        answer({"message": "error", "reason": f"{type(error).__name__}: {error}"})
        raise
    finally:
        if plant is not None:
            plant.close()
