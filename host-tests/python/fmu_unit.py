"""A unit for co-simulation with its variables by name."""

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave


class Unit:
    """An instance of a unit; values are set and read by name."""

    def __init__(self, path, parameters={}, inputs={}):
        self.description = read_model_description(path)
        self.variables = {variable.name: variable for variable in self.description.modelVariables}
        self.slave = FMU2Slave(
            guid=self.description.guid,
            unzipDirectory=extract(path),
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="unit",
        )
        self.slave.instantiate()
        self.slave.setupExperiment(startTime=0.0)
        self.begin(parameters, inputs)

    def begin(self, parameters, inputs):
        """Initialises it."""
        self.set(**parameters)
        self.slave.enterInitializationMode()
        self.set(**inputs)
        self.slave.exitInitializationMode()

    def set(self, **values):
        """Sets variables by name."""
        for name, value in values.items():
            variable = self.variables[name]
            setter = {"Real": self.slave.setReal, "Boolean": self.slave.setBoolean}[variable.type]
            setter([variable.valueReference], [value])

    def get(self, *names):
        """Values of variables by name."""
        return [self.getter(name)([self.variables[name].valueReference])[0] for name in names]

    def getter(self, name):
        slave = self.slave
        getters = {
            "Real": slave.getReal,
            "Integer": slave.getInteger,
            "Boolean": slave.getBoolean,
            "String": slave.getString,
        }
        return getters[self.variables[name].type]

    def step(self, at_s, step_s):
        """Takes a step."""
        self.slave.doStep(currentCommunicationPoint=at_s, communicationStepSize=step_s)
