"""The part of PyFMI that BOPTEST's `testcase.py` uses, over FMPy (`pip install fmpy`): PyFMI itself comes without wheels.

A simulation is one communication step after the other, of equal length, with the inputs held. Results are the values at the ends of
the steps, and the first at the start.
"""

import shutil
import tempfile

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

# The numbers of causalities in PyFMI.
CAUSALITIES = {2: "input", 3: "output"}


def load_fmu(path, *_arguments, **_keywords):
    """An FMU 2.0 for co-simulation."""
    return Unit(path)


class Unit:
    def __init__(self, path):
        self.description = read_model_description(path, validate=False)
        self._folder = extract(path, unzipdir=tempfile.mkdtemp())
        self._variables = {variable.name: variable for variable in self.description.modelVariables}
        self._slave = FMU2Slave(
            guid=self.description.guid,
            unzipDirectory=self._folder,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="case",
        )
        self._slave.instantiate()

    def close(self):
        shutil.rmtree(self._folder, ignore_errors=True)

    def set_log_level(self, _level):
        pass

    def get_version(self):
        return self.description.fmiVersion

    def get_model_variables(self, causality):
        wanted = CAUSALITIES[causality]
        return {name: variable for name, variable in self._variables.items() if variable.causality == wanted}

    def get_variable_unit(self, name):
        return self._variables[name].unit or "1"

    def get_variable_description(self, name):
        return self._variables[name].description

    def get_variable_min(self, name):
        return float(self._variables[name].min)

    def get_variable_max(self, name):
        return float(self._variables[name].max)

    def simulate_options(self):
        return {"ncp": 500, "initialize": True, "filter": None}

    def reset(self):
        self._slave.reset()

    def _set(self, name, value):
        variable = self._variables[name]
        if variable.type == "Boolean":
            self._slave.setBoolean([variable.valueReference], [bool(value)])
        else:
            self._slave.setReal([variable.valueReference], [float(value)])

    def simulate(self, start_time, final_time, options, input=None):
        if options["initialize"]:
            self._slave.setupExperiment(startTime=start_time)
            self._slave.enterInitializationMode()
            self._slave.exitInitializationMode()
        if input is not None:
            names, rows = input
            for name, value in zip(names, np.atleast_2d(rows)[0][1:]):
                self._set(name, value)
        names = [name for name in options["filter"] if self._variables[name].type == "Real"]
        booleans = [name for name in options["filter"] if self._variables[name].type == "Boolean"]
        references = [self._variables[name].valueReference for name in names]
        flags = [self._variables[name].valueReference for name in booleans]
        steps = options["ncp"] if final_time > start_time else 0
        times = np.linspace(start_time, final_time, steps + 1)
        values = []
        for index, time in enumerate(times):
            if index > 0:
                self._slave.doStep(times[index - 1], time - times[index - 1])
            values.append(self._slave.getReal(references) + [float(flag) for flag in self._slave.getBoolean(flags)])
        table = np.array(values)
        results = {name: table[:, column] for column, name in enumerate(names + booleans)}
        results["time"] = times
        return results
