"""Sensors of inputs, driving functions and the solver, constants, and notices of a run."""

from collections.abc import Sequence
from dataclasses import replace

from mbs.common.affine import Affine
from mbs.common.checks import number, one_of, shown
from mbs.common.checks import text as checked_text
from mbs.common.errors import ModelError
from mbs.kernel.header.enumerations import DrivingFunctionType, SensorType, SolverValue
from mbs.model.driving_functions import owned_driving_function
from mbs.model.inputs import owned_input
from mbs.model.joint_reactions import driving_terms
from mbs.model.joints.joint import Joint
from mbs.model.records import DrivingFunction, Input
from mbs.model.sensor import Sensor
from mbs.model.sensor_arguments import sensed_joints
from mbs.model.sensors import RATE_UNITS, SensorVocabulary, order_number

SOLVER = tuple(value.name.lower() for value in SolverValue)
SOLVER_UNITS = {SolverValue.VIOLATION: "m", SolverValue.RESIDUAL: "m", SolverValue.ENERGY_ERROR: "J"}
SOLVER_WHOLE = (
    SolverValue.ITERATIONS,
    SolverValue.FACTORIZATIONS,
    SolverValue.HALVINGS,
    SolverValue.STATUS,
    SolverValue.CAPPED,
)
DRIVING_READINGS = {
    "motion": SensorType.DRIVING,
    "excess": SensorType.DRIVING_EXCESS,
    "force": SensorType.REACTION_PRODUCTS,
}


class ChannelSensorVocabulary(SensorVocabulary):
    """Sensors of inputs, driving functions, elements and the solver."""

    def sense_constant(
        self,
        name: str,
        value: float,
        *,
        unit: str = "1",
        description: str = "",
        whole: bool = False,
        computed: bool = True,
    ) -> Sensor:
        """A number that does not change.

        Parameters
        ----------
        value : float
            In `unit`.
        whole : bool
            Whether an FMU shows it as an integer.
        computed : bool
            False where this number only stands for one that the same scene computes at another fidelity: the FMU then
            logs once that it was read, and which fidelities compute it.
        """
        x = number(value, f"The value of sensor '{name}'")
        unit_signal = [Affine({}, 1.0)]
        return self._sense(
            name, unit, description, SensorType.SIGNAL, unit_signal, reals=[x], whole=whole, computed=computed
        )

    def sense_input(
        self, name: str, input: Input, *, scale: float = 1.0, unit: str = "", description: str = ""
    ) -> Sensor:
        """An input as it is used, within its limits, by default in its own unit.

        Parameters
        ----------
        scale : float
            Factor on it; by another one than 1 it is not a whole number.
        """
        channel = owned_input(self, input, f"The sensor '{name}'")
        unit, integers = self._unit(unit, channel.unit), [channel.index]
        factor = number(scale, f"The scale of sensor '{name}'")
        if factor != 1.0:
            return self._sense(name, unit, description, SensorType.SCALED_INPUT, integers=integers, reals=[factor])
        return self._sense(name, unit, description, SensorType.INPUT, integers=integers, whole=channel.whole)

    def sense_guide(
        self,
        name: str,
        guide: DrivingFunction,
        kind: str = "motion",
        *,
        order: int = 0,
        joints: Sequence[Joint] | None = None,
        scale: float = 1.0,
        unit: str = "",
        description: str = "",
    ) -> Sensor:
        """A driving function or one of its rates, its excess over the limits, or its force.

        Parameters
        ----------
        kind : {"motion", "excess", "force"}
            The motion; of a driving function from `guide_inputs` the excess of the sum of its inputs over the limits,
            zero within them; or the force with which it moves its joints, also by driving functions that follow it by a
            table, in the direction of its motion: its power divided by its rate.
        order : {0, 1, 2}
            Of the motion: the value, its rate or its second rate.
        joints : sequence of Joint, optional
            Of the force: drives, and distances whose end the driving function slides; by default all that there are so
            far.
        scale : float
            Factor on it.
        unit : str
            By default the unit of the driving function, or of its rate if the driving function is in m or rad; for a
            force N or N m.

        Raises
        ------
        ModelError
            The driving function has no limits, or none of the joints follows it.
        """
        subject = f"sensor '{name}'"
        one_of(kind, DRIVING_READINGS, f"The kind of {subject}")
        motion, factor = owned_driving_function(self, guide, f"The {subject}"), number(scale, f"The scale of {subject}")
        k = order_number(order, 2 if kind == "motion" else 0, subject)
        if kind == "force":
            return _driving_force(self, name, motion, joints, factor, unit, description)
        if joints is not None:
            raise ModelError(f"The {subject} reads the {kind} of a driving function; joints are for its force.")
        if kind == "excess" and motion.type != DrivingFunctionType.OF_TWO_INPUTS:
            raise ModelError(
                f"The driving function '{motion.name}' of {subject} has no limits; those of guide_inputs have."
            )
        integers = [motion.index, k] if kind == "motion" else [motion.index]
        unit = self._unit(unit, RATE_UNITS.get(motion.unit, (motion.unit,) * 3)[k])
        return self._sense(name, unit, description, DRIVING_READINGS[kind], integers=integers, reals=[factor])

    def sense_solver(self, name: str, kind: str, *, description: str = "") -> Sensor:
        """Sense a quantity of the solver.

        Parameters
        ----------
        kind : str
            "iterations" and "status" of the last step, "violation" (m) and "residual" (m) after it; since the start
            "factorizations", "halvings", "energy_error" (J, added by the steps without a force) and
            "energy_balance" (see `Report`) and "capped" (steps that ended at `Settings.step_iterations`).
        """
        one_of(kind, SOLVER, f"The kind of solver sensor '{name}'")
        value = SolverValue[kind.upper()]
        unit, whole = SOLVER_UNITS.get(value, "1"), value in SOLVER_WHOLE
        return self._sense(name, unit, description, SensorType.SOLVER, integers=[value], whole=whole)

    def notice(self, sensor: Sensor, text: str) -> Sensor:
        """Add a sentence to the notices of a run in which a sensor is not zero.

        `Trajectory.notices` has the sentence with the first time and the largest value; the run continues.

        Parameters
        ----------
        text : str
            The beginning of the sentence.

        Raises
        ------
        ModelError
            The text is empty.
        """
        is_own = isinstance(sensor, Sensor) and any(s is sensor for s in self.sensors)
        if not is_own or not isinstance(text, str) or not text.strip():
            raise ModelError(
                f"A notice of model {self.name!r} needs a sensor and a sentence, got {shown(sensor)}, {shown(text)}."
            )
        with_notice = replace(sensor, notice=checked_text(text, f"The notice of sensor '{sensor.name}'"))
        self.sensors = [with_notice if s is sensor else s for s in self.sensors]
        return with_notice


def _driving_force(
    model: SensorVocabulary,
    name: str,
    guide: DrivingFunction,
    joints: Sequence[Joint] | None,
    factor: float,
    unit: str,
    description: str,
) -> Sensor:
    sensed = model.joints if joints is None else sensed_joints(model, name, "joints", joints)
    terms = [replace(t, weight=factor * t.weight) for joint in sensed for t in driving_terms(joint, guide.index)]
    by_table = [g.index for g in model.guides if g.type == DrivingFunctionType.BY_TABLE and g.input == guide.index]
    terms += [
        replace(t, weight=factor * t.weight, slope=g)
        for g in by_table
        for joint in sensed
        for t in driving_terms(joint, g)
    ]
    if not terms:
        raise ModelError(
            f"The sensor '{name}' asks for the force of driving function '{guide.name}', "
            "which none of its joints follows."
        )
    unit = model._unit(unit, {"m": "N", "rad": "N.m"}.get(guide.unit, "1"))
    kind = SensorType.REACTION_BY_TABLE if by_table else DRIVING_READINGS["force"]
    return model._sense(name, unit, description, kind, terms=terms)
