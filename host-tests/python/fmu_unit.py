"""A unit for co-simulation, of FMI 2.0, with its variables by name."""

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE


class Unit:
    """An instance of a unit; values are set and read by name. Messages go into a list, if one is given."""

    def __init__(self, path, parameters={}, inputs={}, messages=None):
        self.description = read_model_description(path)
        self.variables = {variable.name: variable for variable in self.description.modelVariables}
        self.slave = FMU2Slave(
            guid=self.description.guid,
            unzipDirectory=extract(path),
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="unit",
        )
        instantiate(self.slave, messages)
        self.begin(parameters, inputs)

    def begin(self, parameters, inputs, stop_s=None):
        """Initialises it."""
        self.set(**parameters)
        self.slave.setupExperiment(startTime=0.0, stopTime=stop_s)
        self.slave.enterInitializationMode()
        self.set(**inputs)
        self.slave.exitInitializationMode()

    def function(self, what, type):
        """The function that gets or sets values of a type."""
        return getattr(self.slave, f"{what}{type}")

    def set(self, **values):
        """Sets variables by name."""
        for name, value in values.items():
            variable = self.variables[name]
            self.function("set", variable.type)([variable.valueReference], [value])

    def get(self, *names):
        """Values of variables by name."""
        return [self.value(self.variables[name]) for name in names]

    def value(self, variable):
        value = self.function("get", variable.type)([variable.valueReference])[0]
        return value.decode() if isinstance(value, bytes) else value

    def step(self, at_s, step_s):
        """Takes a step."""
        return self.slave.doStep(currentCommunicationPoint=at_s, communicationStepSize=step_s)

    def state(self, what, *arguments):
        """Gets, sets, frees or serializes a state."""
        return getattr(self.slave, f"{what}FMUstate")(*arguments)


def instantiate(slave, messages=None):
    """Makes an instance; its messages go into a list, if one is given."""
    callbacks = None
    if messages is not None:
        callbacks = fmi2CallbackFunctions()
        callbacks.logger = fmi2CallbackLoggerTYPE(lambda *said: messages.append(said[-1].decode()))
    slave.instantiate(callbacks=callbacks)
