"""Sensors of inputs, guides and the solver, constants, and notices of a run."""

from __future__ import annotations

from dataclasses import replace

from mbs.common.affine import Affine
from mbs.common.checks import number, one_of, shown
from mbs.common.checks import text as checked_text
from mbs.common.errors import ModelError
from mbs.kernel.header import GuideType, SensorType, SolverValue
from mbs.model.guides import owned_guide
from mbs.model.inputs import owned_input
from mbs.model.records import Guide, Input
from mbs.model.sensor import Sensor
from mbs.model.sensors import SensorBase, order_number

SOLVER = tuple(value.name.lower() for value in SolverValue)
SOLVER_UNITS = {SolverValue.VIOLATION: "m", SolverValue.RESIDUAL: "m", SolverValue.ENERGY_ERROR: "J"}
SOLVER_WHOLE = (
    SolverValue.ITERATIONS,
    SolverValue.FACTORIZATIONS,
    SolverValue.HALVINGS,
    SolverValue.STATUS,
    SolverValue.CAPPED,
)


class ChannelSensorVocabulary(SensorBase):
    """What can be read beside motion and forces."""

    def sense_constant(
        self,
        name: str,
        value: float,
        unit: str = "1",
        description: str = "",
        whole: bool = False,
        computed: bool = True,
    ) -> Sensor:
        """A number that does not change.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        value : float
            The number.
        unit, description : str
            For files, plots and hosts.
        whole : bool
            Whether an FMU shows it as an integer.
        computed : bool
            False where this number only stands for one that the same scene computes at another fidelity: the FMU then
            logs once that it was read, and which fidelities compute it.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The name is taken, or the value is no finite number.
        """
        x = number(value, f"The value of sensor '{name}'")
        one = [Affine({}, 1.0)]
        return self._sense(name, unit, description, SensorType.SIGNAL, one, reals=[x], whole=whole, computed=computed)

    def sense_input(self, name: str, input: Input, unit: str = "", description: str = "") -> Sensor:
        """An input as it is used, within its limits.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        input : Input
            Of this model.
        unit, description : str
            For files, plots and hosts; by default the unit of the input.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The name is taken, or the input is not of this model.
        """
        channel = owned_input(self, input, f"The sensor '{name}'")
        return self._sense(
            name,
            self._unit(unit, channel.unit),
            description,
            SensorType.INPUT,
            integers=[channel.index],
            whole=channel.whole,
        )

    def sense_guide(
        self, name: str, guide: Guide, order: int = 0, scale: float = 1.0, unit: str = "", description: str = ""
    ) -> Sensor:
        """A guide or one of its rates.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        guide : Guide
            Of this model.
        order : {0, 1, 2}
            The value, its rate or its second rate.
        scale : float
            Factor on it.
        unit, description : str
            For files, plots and hosts; by default the unit of the guide.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The name is taken, the guide is not of this model, or the order is none.
        """
        what = f"sensor '{name}'"
        motion, k = owned_guide(self, guide, f"The {what}"), order_number(order, 2, what)
        factor = number(scale, f"The scale of {what}")
        return self._sense(
            name,
            self._unit(unit, motion.unit),
            description,
            SensorType.GUIDE,
            integers=[motion.index, k],
            reals=[factor],
        )

    def sense_guide_excess(
        self, name: str, guide: Guide, scale: float = 1.0, unit: str = "", description: str = ""
    ) -> Sensor:
        """What the limits of a guide of two inputs take away from the sum of its inputs.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        guide : Guide
            From `guide_inputs`.
        scale : float
            Factor on it.
        unit, description : str
            For files, plots and hosts; by default the unit of the guide.

        Returns
        -------
        Sensor
            As it stands in the System; zero where the guide follows its inputs.

        Raises
        ------
        ModelError
            The name is taken, or the guide is not of this model or has no limits.
        """
        what = f"sensor '{name}'"
        motion, factor = owned_guide(self, guide, f"The {what}"), number(scale, f"The scale of {what}")
        if motion.type != GuideType.OF_TWO_INPUTS:
            raise ModelError(f"The guide '{motion.name}' of {what} has no limits; those of guide_inputs have.")
        unit = self._unit(unit, motion.unit)
        return self._sense(name, unit, description, SensorType.GUIDE_EXCESS, integers=[motion.index], reals=[factor])

    def sense_solver(self, name: str, kind: str, description: str = "") -> Sensor:
        """What the solver says about itself.

        Parameters
        ----------
        name : str
            Unique among the sensors.
        kind : str
            "iterations" and "status" of the last step, "violation" (m) and "residual" (m) after it; since the start
            "factorizations", "halvings", "energy_error" (J, what the steps gave where no force did) and
            "energy_balance" (the same over the largest kinetic energy and the work) and "capped" (steps that ended
            at `Settings.step_iterations`).
        description : str
            For files, plots and hosts.

        Returns
        -------
        Sensor
            As it stands in the System.

        Raises
        ------
        ModelError
            The name is taken, or there is no such kind.
        """
        one_of(kind, SOLVER, f"The kind of solver sensor '{name}'")
        value = SolverValue[kind.upper()]
        return self._sense(
            name,
            SOLVER_UNITS.get(value, "1"),
            description,
            SensorType.SOLVER,
            integers=[value],
            whole=value in SOLVER_WHOLE,
        )

    def notice(self, sensor: Sensor, text: str) -> Sensor:
        """Let a run say a sentence when a sensor is not zero, so that users need not look at every output.

        `Trajectory.notices` has the sentence with the first time and the largest value; the run goes on.

        Parameters
        ----------
        sensor : Sensor
            Of this model.
        text : str
            The beginning of the sentence.

        Returns
        -------
        Sensor
            The sensor with its sentence.

        Raises
        ------
        ModelError
            The sensor is not of this model, or the text is empty.
        """
        known = isinstance(sensor, Sensor) and any(s is sensor for s in self.sensors)
        if not known or not isinstance(text, str) or not text.strip():
            raise ModelError(
                f"A notice of model {self.name!r} needs a sensor and a sentence, got {shown(sensor)}, {shown(text)}."
            )
        with_notice = replace(sensor, notice=checked_text(text, f"The notice of sensor '{sensor.name}'"))
        self.sensors = [with_notice if s is sensor else s for s in self.sensors]
        return with_notice
