"""Stepping of a System by the caller (`Simulation`)."""

import json
import math
import os
import warnings
from collections.abc import Callable, Mapping
from dataclasses import astuple
from typing import Any
from zlib import crc32

from ali3.message_text import unit_text
from mbs.common.checks import flag, instance_of, is_finite, number, positive, shown, whole
from mbs.common.progress import progress_for
from mbs.kernel.binding import KernelError, Status
from mbs.kernel.binding.instance import Instance
from mbs.kernel.header.limits import LONGEST_SETTLING, MOST_PARTS
from mbs.kernel.header.structures import ComparedFields
from mbs.results import accuracy
from mbs.results.accuracy import AccuracyWarning
from mbs.results.equilibrium_warning import warn_if_unstable
from mbs.results.trajectory import Trajectory
from mbs.roads.package_roads import road_path
from mbs.roads.steep_faces import RoadWarning
from mbs.settings.input_signals import InputSignals, Signal
from mbs.settings.settings import Settings
from mbs.settings.tolerance import Tolerance
from mbs.simulation.arguments import (
    check_end,
    check_estimate,
    check_every,
    check_pose,
    check_progress,
    check_resolution,
    check_settings,
    check_step,
    check_system,
    check_time,
    check_tolerance_settings,
    check_values,
    count_steps,
    record_times,
    requested_tolerance,
)
from mbs.simulation.fixed_steps import Motion, run_fixed_steps
from mbs.simulation.omitted_sensors import Readings
from mbs.simulation.parameter_warning import warn_if_out_of_range
from mbs.simulation.refusal import refusal
from mbs.simulation.start_on_road import warn_of_start_beside_road
from mbs.simulation.state import Pose
from mbs.simulation.stepped_system import SteppedSystem, restore_system
from mbs.simulation.tolerance_run import to_tolerance
from mbs.system.system import System

SINGULAR = {"switches": "switch"}
"""Singular of a key of the metadata, if it is not the key without its last letter."""
MAX_ITERATIONS = 10**6
"""Largest bound on the Newton iterations of a static equilibrium."""


class Simulation(SteppedSystem):
    """A System in motion.

    Parameters
    ----------
    inputs : mapping of str to float, optional
        Values of inputs at the start; the others have the start values of the model.
    parameters : mapping of str to float, optional
        Values that differ from the model.
    pose : Pose, optional
        Initial pose of a model without a connection to the ground.
    t0 : float
        Time at the start, s.

    Raises
    ------
    ArgumentTypeError
        An argument has the wrong type, such as a Model instead of a System.
    ValueError
        A name is unknown, a value lies outside its limits, or the System takes no pose.
    SimulationError
        The start cannot be made consistent, or is refused: below a road, too far away.
    """

    def __init__(
        self,
        system: System,
        *,
        settings: Settings | None = None,
        inputs: Mapping[str, float] | None = None,
        parameters: Mapping[str, Any] | None = None,
        pose: Pose | None = None,
        t0: float = 0.0,
    ) -> None:
        system, settings = check_system(system, "The system of a Simulation"), check_settings(settings)
        start = check_time(t0, "The start t0")
        super().__init__(system, settings)
        self._warned = self._rim_reported = False
        self._refined: SteppedSystem | None = None
        self._divisor = 0  # of the step in the refined run
        self._extremes: dict[str, ComparedFields] = {}  # of the quantities compared in runs so far
        self._limits = InputSignals({}, self._meta["inputs"])
        self._road_files = {entry["name"]: entry for entry in self._meta.get("road_files", ())}
        self._started = False
        checked_parameters = check_values(parameters, "The parameters")
        for name, entry in self._road_files.items():
            if entry["start"] and name not in checked_parameters:
                self.set_parameter(name, entry["start"])
        for name, value in checked_parameters.items():
            self.set_parameter(name, value)
        self._warn_of_replaced_roads(checked_parameters)
        for name, value in check_values(inputs, "The inputs").items():
            self.set_input(name, value)
        if (checked_pose := check_pose(pose, self._meta)) is not None:
            self._call(
                f"The starting {checked_pose} was refused", lambda: self.instance.set_pose(*astuple(checked_pose))
            )
        if self._meta["floating"]:
            warn_of_start_beside_road(system, self.road_paths, pose, 2)
        self._call("The start could not be made consistent", lambda: self.instance.initialise(start))
        self._started = True

    @property
    def sensors(self) -> dict[str, float]:
        """Sensor values at the state, by name; omitted ones are computed when one is first read."""
        computed = super().sensors
        if len(computed) == len(self._meta["sensors"]):
            return computed
        return Readings(computed, self.system, self.instance)

    def set_input(self, name: str, value: float) -> None:
        """Set the value of an input.

        Parameters
        ----------
        value : float
            Value in the unit of the input, within its limits.

        Raises
        ------
        ValueError
            There is no such input, or the value is not within its limits.
        """
        index = self._index("inputs", name)
        x = number(value, f"The value of input {name!r}", ValueError)
        self._limits.check(index, self.time, x)
        self.instance.set_input(index, x)
        self._apply_to_refined(lambda run: run.set_input(index, x))

    def set_parameter(self, name: str, value: float | str | os.PathLike[str]) -> None:
        """Set a tunable parameter; the next step is the first with its value.

        Issues a `ParameterWarning` for a value outside the range of validity, see `Model.parameter`.

        Parameters
        ----------
        value : float or path
            Value in the unit of the parameter, within its limits. For the file of a road its path, or the name of a
            road of the package; empty for the road of the model. It is fixed: give it to the constructor.

        Raises
        ------
        ValueError
            There is no such parameter, it is fixed, the value is not within its limits, the model cannot take it beside
            the other values, or the file of a road is refused.
        """
        if isinstance(name, str) and name in self._road_files:
            self._set_road(self._road_files[name], value)
            return
        index = self._index("parameters", name)
        entry = self._meta["parameters"][index]
        x = float(value) if is_finite(value) else math.nan  # type: ignore[arg-type]
        if not entry["min"] <= x <= entry["max"]:
            raise ValueError(
                f"Parameter {name!r} is set to {shown(value)}{unit_text(entry['unit'])}; "
                f"it must lie between {entry['min']:g} and {entry['max']:g}."
            )
        try:
            self.instance.set_parameter(index, x)
        except KernelError as error:
            if error.status == Status.FIXED_PARAMETER:
                raise ValueError(
                    f"Parameter {name!r} is fixed and cannot be set at t = {self.time:g} s; start a simulation with "
                    f"it: Simulation(system, parameters={{{name!r}: {shown(value)}}})."
                ) from None
            raise ValueError(
                f"Parameter {name!r} is set to {shown(value)}{unit_text(entry['unit'])}, which the model cannot take "
                "beside its other values."
            ) from None
        warn_if_out_of_range(entry, x, stacklevel=2 if self._started else 3)
        self._apply_to_refined(lambda run: run.set_parameter(index, x))

    def _apply_to_refined(self, change: Callable[[Instance], object]) -> None:
        """Apply a change to the refined run of checked runs too; drop that run if it fails."""
        try:
            if self._refined is not None:
                change(self._refined.instance)
        except KernelError:
            self._refined = None

    def _drop_refused(self, time_tolerance: float) -> None:
        """Drop the refined run if it was refused on its way, more than the tolerance from the time of this one, s."""
        if self._refined is not None and abs(self._refined.time - self.time) > time_tolerance:
            self._refined = None

    def _warn_of_replaced_roads(self, parameters: Mapping[str, Any]) -> None:
        """Warn of parameters of roads that files replace."""
        files = {entry["road"] for name, entry in self._road_files.items() if parameters.get(name, entry["start"])}
        for entry in self._meta["parameters"]:
            if entry["name"] in parameters and entry.get("road") in files:
                warnings.warn(
                    f"The parameter {entry['name']!r} has no effect: it belongs to the road that the file replaces.",
                    RoadWarning,
                    stacklevel=3,
                )

    def _set_road(self, entry: Mapping[str, Any], value: object) -> None:
        """Set the file of a road at the start. `entry`: entry of the parameter in `System.meta`."""
        name = entry["name"]
        if self._started:
            raise ValueError(f"Parameter {name!r} is fixed: give the file of a road to the Simulation's constructor.")
        if not isinstance(value, str | os.PathLike):
            raise ValueError(f"Parameter {name!r} is set to {shown(value)}; it is the path of a road file.")
        path = road_path(value)
        try:
            self.instance.set_road(entry["road"], path)
        except KernelError as error:
            raise ValueError(f"Parameter {name!r}: {error.message}") from None
        self.road_paths[entry["road"]] = path

    def set_switch(self, name: str, on: bool) -> float:
        """Turn the rows of a switch on or off.

        Rows that are turned on keep their present values; velocities change to the nearest ones that satisfy them, as
        in an impact without rebound.

        Parameters
        ----------
        on : bool
            Whether its rows hold.

        Returns
        -------
        float
            Change of the kinetic energy, J.

        Raises
        ------
        ValueError
            There is no such switch, or `on` is neither True nor False.
        SimulationError
            The rows cannot hold at this state; the switch is not changed.
        """
        index = self._index("switches", name)
        flag(on, f"The position of switch {name!r}", ValueError)
        before = self.instance.get_switch(index)
        self._call(
            f"Switch {name!r} could not be turned {'on' if on else 'off'} at t = {self.time:g} s",
            lambda: self.instance.set_switch(index, on),
        )
        self._apply_to_refined(lambda run: run.set_switch(index, on))
        return self.report.energy_jump if before != bool(on) else 0.0

    def switch(self, name: str) -> bool:
        """Whether the rows of a switch are on.

        Returns
        -------
        bool
            Whether they hold.

        Raises
        ------
        ValueError
            There is no such switch.
        """
        return self.instance.get_switch(self._index("switches", name))

    def static_equilibrium(self, tolerance: float = 1e-6, max_iterations: int = 1000) -> None:
        """Move to the static equilibrium near the present position, all velocities zero, time unchanged.

        Parameters
        ----------
        tolerance : float
            Largest force out of balance, N or N m.
        max_iterations : int
            Bound on the Newton iterations.

        Raises
        ------
        ValueError
            The tolerance is not positive, or the bound is not a whole number above zero.
        SimulationError
            No equilibrium was found; the state is not changed.

        Warns
        -----
        EquilibriumWarning
            The equilibrium is unstable.
        """
        force = positive(tolerance, "The tolerance of the static equilibrium", ValueError)
        iterations = whole(max_iterations, "max_iterations", 1, MAX_ITERATIONS, ValueError)
        self._refined = None
        self._call(
            "No static equilibrium was found near the present position",
            lambda: self.instance.static_equilibrium(self.time, force, iterations),
        )
        warn_if_unstable(self.report.negative_pivots, "The static equilibrium", stacklevel=2)

    def settle(self, duration: float, h: float) -> float:
        """Hold the horizontal motion of a start while roll, tyres, springs and steering settle, time unchanged.

        After each step the scene is moved back as a whole: position along the ground and horizontal velocity of its
        heaviest point, heading and yaw rate of its heaviest direction stay, on a slope along the slope. A scene above
        its road is lowered to it first. Works are counted from here, as in an FMU with `initial.settling`.

        Parameters
        ----------
        duration : float
            Duration of settling, s, at most 10.
        h : float
            Step, s.

        Returns
        -------
        float
            Largest remaining speed relative to the held motion, m/s; above 0.01 the duration was too short.

        Raises
        ------
        ValueError
            The duration or the step is out of its range, or joints tie the scene to the ground.
        SimulationError
            A step failed; the state is not changed.
        """
        seconds, step = number(duration, "The duration of settling", ValueError), check_step(h)
        if not 0.0 <= seconds <= LONGEST_SETTLING:
            raise ValueError(
                f"The duration of settling is {seconds:g} s; it must lie between 0 and {LONGEST_SETTLING:g} s."
            )
        if not self._meta.get("floating", True):
            name = self._meta["name"]
            raise ValueError(f"The System {name!r} cannot settle in motion: its joints tie it to the ground.")
        self._refined, self.step_tried, state = None, step, self.instance.save()
        try:
            return self.instance.settle(seconds, step)
        except KernelError as error:
            simulation_error = refusal(self, "The start did not settle", error, step_given=True)
            self.instance.restore(state)
            raise simulation_error from error

    def step(self, h: float, n: int = 1) -> None:
        """Make steps with the inputs as they are; a refined run of `run` makes its own.

        Parameters
        ----------
        h : float
            Length of a step, s.
        n : int
            Number of steps.

        Raises
        ------
        ValueError
            The step is not positive or lost in the round-off of the time, or `n` is not a whole number.
        SimulationError
            A step failed; the state is the last good one.

        Warns
        -----
        AccuracyWarning
            Once, when the energy balance since the start shows that the result is wrong.
        """
        h = check_step(h)
        if not is_finite(n) or n != int(n) or n < 0:
            raise ValueError(f"n = {shown(n)}; it must be a whole number of steps.")
        check_time(self.time + n * h, f"The end of n = {shown(n)} steps of {h:g} s")
        check_resolution(self.time, h)
        self.step_tried = h
        for _ in range(int(n)):
            subject = f"The step from t = {self.time:g} s with h = {h:g} s failed"
            self._call(subject, lambda: self.instance.step(h), step_given=True)
            self._apply_to_refined(lambda run: run.run(h / self._divisor, self._divisor))
        self._warn_once()

    def run(
        self,
        t_end: float,
        h: float | None = None,
        *,
        inputs: Mapping[str, Signal] | None = None,
        every: int = 1,
        progress: bool | Callable[[float], None] | None = None,
        estimate_error: bool | float | None = None,
        tolerance: float | Mapping[str, float] | None = None,
    ) -> Trajectory:
        """Step from the present time to `t_end`; switches and inputs set before stay as they are.

        Parameters
        ----------
        t_end : float
            Time at which to stop, s; when h does not divide the duration, the last step ends less than h before it.
        h : float, optional
            Step, s. With a tolerance: interval of the record, by default 1/200 of the duration.
        inputs : mapping of str to signal, optional
            Per input a constant, a function of time alone, which is sampled ahead, or a pair (times, values); see
            `simulate`. An input whose first value differs from its present value jumps at the start, and the first
            sample is before the jump. (`simulate` starts with the first values, as ``Simulation(system, inputs=...)``.)
        every : int
            Record every n-th step, or every n-th interval of the record.
        progress : bool or callable, optional
            None shows a bar if the run takes longer than two seconds, True at once, False never; a function receives
            the fraction done.
        estimate_error : bool or float, optional
            As in `simulate`, for the first doubtful run after eight steps. The last refined run continues in the
            following calls, also of `step`, with the same inputs, parameters and switches, until one with False.
        tolerance : float or mapping of str to float, optional
            As in `simulate`, for the error that this part adds; with the method of the settings.

        Returns
        -------
        Trajectory
            Sensor values, beginning with the present ones.

        Raises
        ------
        ValueError
            Neither h nor a tolerance is given.
        SimulationError
            A step failed; its `trajectory` holds the record until then.

        Warns
        -----
        AccuracyWarning
            A refined run or the energy balance since the start shows that the result is wrong, once; a tolerance is not
            kept, each time.
        BranchWarning
            A step jumped to another branch.
        BendingWarning
            A flexible body deforms more than its linear modes allow, once.
        """
        if tolerance is not None:
            requested = requested_tolerance(self.system, tolerance)
            return self._to_tolerance(requested, t_end, h, inputs, every, progress)
        if h is None:
            raise ValueError("A run needs a step h or a tolerance.")
        estimate_error = check_estimate(estimate_error)
        every = check_every(every)
        check_progress(progress)
        # in the first few steps a range is so small that the start of a motion is a large share of it
        steps = self.report.steps + count_steps(self.time, t_end, check_step(h))
        checked = estimate_error is not False and steps >= MOST_PARTS
        existing = self._refined if checked else None
        state = self.instance.save() if checked and existing is None else b""
        is_started = False
        self._refined = None

        def start(_: float) -> SteppedSystem:
            nonlocal is_started
            if not is_started:
                is_started = True
                return self
            self._refined = existing if existing is not None else self._restored(state)
            return self._refined

        divisor = self._divisor if existing is not None else 0

        motion = Motion(self.system, start, self.time, t_end, inputs, every, progress)

        def equal_steps() -> Trajectory:  # a call as deep as in `simulate`, for the stack level of warnings
            return run_fixed_steps(motion, h, estimate_error if checked else False, self._extremes, divisor)

        trajectory = equal_steps()
        self._drop_refused(0.5 * h)
        run_accuracy = trajectory.accuracy
        if run_accuracy is not None and run_accuracy.compared_step is not None:
            self._divisor = max(1, round(h / run_accuracy.compared_step))
        if run_accuracy is not None and run_accuracy.message and not self._warned:
            self._warned = True
            warnings.warn(run_accuracy.message, AccuracyWarning, stacklevel=2)
        if estimate_error is not False:
            self._warn_once(right=run_accuracy is not None and bool(run_accuracy.notice))
        return trajectory

    def _to_tolerance(
        self,
        tolerance: Tolerance,
        t_end: float,
        h: float | None,
        inputs: Mapping[str, Signal] | None,
        every: int,
        progress: bool | Callable[[float], None] | None,
    ) -> Trajectory:
        check_tolerance_settings(self.settings)
        times = record_times(self.time, check_end(self.time, t_end), h, check_every(every), None)
        state, checked_inputs = self.instance.save(), check_values(inputs, "The inputs")
        self._refined = None
        with progress_for(progress) as bar:
            trajectory, ended = to_tolerance(
                lambda: self._restored(state),
                tolerance,
                times,
                checked_inputs,
                self.settings,
                self.settings.method,
                bar,
            )
        self.instance.restore(ended.instance.save())
        self.instance.set_settings(**self.settings.kernel_fields())
        return trajectory

    def _restored(self, state: bytes) -> SteppedSystem:
        """A second instance at a saved state, with the same settings and roads."""
        return restore_system(self.system, self.settings, self.road_paths, state)

    def _warn_once(self, right: bool = False) -> None:
        """Warn once each of a rim pressed into a road and of a wrong energy balance, the latter unless `right`."""
        if not self._rim_reported and (warning := self.road_text):
            self._rim_reported = True
            warnings.warn(warning, RoadWarning, stacklevel=3)
        if self._warned or right or not self.instance.balance_wrong():
            return
        self._warned = True
        text = f"{accuracy.balance_text(self.report)} The result is wrong from before t = {self.time:g} s."
        warnings.warn(f"{text} Take shorter steps.", AccuracyWarning, stacklevel=3)

    def save(self) -> bytes:
        """Save the state, from which a run continues bit for bit, in this or another process.

        Returns
        -------
        bytes
            For `restore`; with the refined run and the ranges of checked runs, if there were any.
        """
        state = self.instance.save()
        if self._refined is None and not self._extremes:
            return state
        refined = b"" if self._refined is None else self._refined.instance.save()
        ranges = {name: bytes(fields).hex() for name, fields in self._extremes.items()}
        check = refined + b"\n" + json.dumps([self._divisor, ranges]).encode()
        return state + b"%08x" % crc32(state + check) + check

    def restore(self, state: bytes) -> None:
        """Continue from a saved state of the same System.

        Raises
        ------
        SimulationError
            The saved state is damaged or of another System; the present state is not changed.
        """
        instance_of((bytes, bytearray), state, "The saved state", "the bytes that save() gave")
        size = self.instance.system.state_size
        own, checksum, check = bytes(state[:size]), state[size : size + 8], bytes(state[size + 8 :])
        refined, _, numbers = check.rpartition(b"\n")

        def restore_both() -> None:
            if checksum and checksum != b"%08x" % crc32(own + check):
                raise KernelError(Status.BAD_STATE, "the bytes of its check were altered.")
            divisor, ranges = json.loads(numbers) if checksum else (0, {})
            other = self._restored(refined) if refined else None
            self.instance.restore(own)
            self._refined, self._divisor = other, divisor
            self._extremes = {n: ComparedFields.from_buffer_copy(bytes.fromhex(text)) for n, text in ranges.items()}

        self._call("The saved state was refused", restore_both)

    def _index(self, kind: str, name: str) -> int:
        """Index of an input, parameter or switch; `kind`: key of the metadata. Raises `ValueError` if there is none."""
        names = [entry["name"] for entry in self._meta[kind]]
        if not isinstance(name, str) or name not in names:
            available = ", ".join(names) or "none"
            raise ValueError(f"There is no {SINGULAR.get(kind, kind[:-1])} {shown(name)}; the System has: {available}.")
        return names.index(name)

    def _call(self, subject: str, action: Callable[[], object], *, step_given: bool = False) -> None:
        """Call the kernel; make a `SimulationError` of its error. `subject`, `step_given`: as in `refusal`."""
        try:
            action()
        except KernelError as error:
            raise refusal(self, subject, error, step_given=step_given) from error
