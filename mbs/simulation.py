"""Stepping a System: by hand with `Simulation`, or a whole run with `simulate`."""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import astuple, dataclass, replace
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mbs import accuracy, repeat
from mbs.accuracy import AccuracyWarning
from mbs.branch_warning import BranchWarning
from mbs.control import checked_tolerance
from mbs.errors import SimulationError
from mbs.input_signals import InputSignals, Signal, unit_text
from mbs.kernel.binding import Instance, KernelError, LoadedSystem, Status, open_row
from mbs.large_bending import BendingWatch
from mbs.progress import progress_for
from mbs.run_report import Report
from mbs.settings import Settings
from mbs.system import System
from mbs.trajectory import Trajectory

SINGULAR = {"switches": "switch"}
STIFF_STEP = 1.0  # fastest rate times step that an explicit method follows well
CHUNK_SECONDS = 0.1  # wall time of one call into the kernel, so that progress moves and Ctrl-C is heard


@dataclass(frozen=True)
class Pose:
    """Where a scene that is not tied to the ground starts.

    Parameters
    ----------
    x, y, z : float
        Shift from the reference configuration, earth axes, m.
    yaw : float
        Turn about the vertical, rad.
    speed : float
        Along the turned forward direction, m/s.
    """

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    yaw: float = 0.0
    speed: float = 0.0


@dataclass(frozen=True)
class State:
    """Position, velocity, acceleration (nq,), multipliers of the stored rows (nc,) and element states (ny,).

    Multipliers have one sign, that of ``M qdd + Phi_q' lam = Q``: a row Phi puts the force -Phi_q' lam on its
    coordinates. ``lam_user = row_scale * lam`` belongs to the row as the model writes it. The row of a drive is
    coordinate minus guide, so the drive pushes the coordinate with -lam_user; the rows of a port and of a node of a
    flexible body are free point minus point of the body, so the body feels +lam_user; a distance of length L has the
    tension L lam_user. Sensors have the signs that their docstrings say.
    """

    q: NDArray[np.float64]
    qd: NDArray[np.float64]
    qdd: NDArray[np.float64]
    lam: NDArray[np.float64]
    y: NDArray[np.float64]


class Simulation:
    """A System in motion.

    Parameters
    ----------
    system : System
        What `compile` made.
    settings : Settings, optional
        How steps are solved.
    inputs : mapping of str to float, optional
        Values of inputs at the start; the others have the start value of their declaration.
    parameters : mapping of str to float, optional
        Values that differ from their declaration.
    pose : Pose, optional
        Start of a scene that is not tied to the ground.
    t0 : float
        Time at the start, s.
    """

    def __init__(
        self,
        system: System,
        *,
        settings: Settings | None = None,
        inputs: Mapping[str, float] | None = None,
        parameters: Mapping[str, float] | None = None,
        pose: Pose | None = None,
        t0: float = 0.0,
    ) -> None:
        self.system = system
        self.bending = BendingWatch(system.frames)
        loaded, self._meta = prepared(system)
        self.settings = settings or Settings()
        self.instance = Instance(loaded)
        self.instance.set_settings(**self.settings.kernel_fields())
        for name, value in (parameters or {}).items():
            self.set_parameter(name, value)
        for name, value in (inputs or {}).items():
            self.set_input(name, value)
        if pose is not None:
            self._call(f"The starting {pose} was refused", lambda: self.instance.set_pose(*astuple(pose)))
        self._call("The start could not be made consistent", lambda: self.instance.initialise(t0))
        self._warned, self._tried = False, 0.0  # whether it has warned, the last step tried

    @property
    def time(self) -> float:
        """Time of the state, s."""
        return float(self.instance.time)

    @property
    def sensors(self) -> dict[str, float]:
        """Sensor values at the state, by name."""
        return {s["name"]: v for s, v in zip(self._meta["sensors"], self._sensor_values().tolist(), strict=True)}

    @property
    def report(self) -> Report:
        """Counters since the start and residuals of the last step."""
        return Report.from_kernel(self.instance.report())

    @property
    def branch_change(self) -> str:
        """A sentence about the first change of the assembly mode of a closed loop since the start; empty: none."""
        return self.instance.branch_text()

    @property
    def state(self) -> State:
        """A copy of the state."""
        return State(*(np.array(part, float) for part in self.instance.get_state()))

    def set_input(self, name: str, value: float) -> None:
        """Value of an input from now on."""
        InputSignals({name: value}, self._meta["inputs"]).at(np.array([self.time]), 0.0)
        self.instance.set_input(self._index("inputs", name), value)

    def set_parameter(self, name: str, value: float) -> None:
        """Value of a parameter from now on."""
        index = self._index("parameters", name)
        entry = self._meta["parameters"][index]
        if not entry["min"] <= value <= entry["max"]:
            raise ValueError(
                f"Parameter {name!r} is set to {value:g}{unit_text(entry['unit'])}; "
                f"it must lie between {entry['min']:g} and {entry['max']:g}."
            )
        self.instance.set_parameter(index, value)

    def set_switch(self, name: str, on: bool) -> float:
        """Turn the rows of a switch on or off.

        Rows that go on hold the values they have at this moment; velocities go to the nearest ones that satisfy them,
        as in an impact without rebound.

        Returns
        -------
        float
            Change of the kinetic energy, J.
        """
        index = self._index("switches", name)
        before = self.instance.get_switch(index)
        self._call(
            f"Switch {name!r} could not be turned {'on' if on else 'off'} at t = {self.time:g} s",
            lambda: self.instance.set_switch(index, on),
        )
        return self.report.energy_jump if before != bool(on) else 0.0

    def switch(self, name: str) -> bool:
        """Whether the rows of a switch are on."""
        return self.instance.get_switch(self._index("switches", name))

    def static_equilibrium(self, tolerance: float = 1e-6, max_iterations: int = 1000) -> None:
        """Move to the static equilibrium near the present position, all velocities zero, time unchanged.

        Parameters
        ----------
        tolerance : float
            Largest force out of balance, N or N m.
        max_iterations : int
            Bound on the Newton iterations.
        """
        self._call(
            "No static equilibrium was found near the present position",
            lambda: self.instance.static_equilibrium(self.time, tolerance, max_iterations),
        )

    def step(self, h: float, n: int = 1) -> None:
        """Make `n` steps of `h` seconds with the inputs as they are.

        Warns
        -----
        AccuracyWarning
            Once, when the energy balance since the start says that the result is wrong.
        """
        _check_step(h)
        self._tried = h
        if n != int(n) or n < 0:
            raise ValueError(f"n = {n}; it must be a whole number of steps.")
        for _ in range(int(n)):
            self._call(f"The step from t = {self.time:g} s with h = {h:g} s failed", lambda: self.instance.step(h))
        self._warn_once()

    def run(
        self,
        t_end: float,
        h: float,
        *,
        inputs: Mapping[str, Signal] | None = None,
        every: int = 1,
        progress: bool | Callable[[float], None] | None = None,
    ) -> Trajectory:
        """Step from the present time to `t_end`; see `simulate`. Only `simulate` can repeat a run to check it.

        Warns
        -----
        AccuracyWarning
            Once, when the energy balance since the start says that the result is wrong.
        BendingWarning
            Once, when a flexible body bends more within its floating frame than its modes hold for.
        """
        trajectory = self._march(t_end, h, inputs, every, progress)[0]
        self._warn_once()
        self.bending.warn(stacklevel=3)
        return trajectory

    def march(self, t_end: float, h: float, inputs: Mapping[str, Signal]) -> Trajectory:
        """As `run`, without a word about the accuracy: for who compares runs himself."""
        return self._march(t_end, h, inputs, 1, False)[0]

    def _march(
        self,
        t_end: float,
        h: float,
        inputs: Mapping[str, Signal] | None,
        every: int,
        progress: bool | Callable[[float], None] | None,
        look: bool = False,
    ) -> tuple[Trajectory, list[NDArray[np.float64]]]:
        """The steps of `run`; with `look` also the coordinates at the instants where two runs are compared."""
        _check_step(h)
        self._tried = h
        t0 = self.time
        steps = _count_steps(t0, t_end, h)
        if every < 1:
            raise ValueError(f"every = {every}; it must be at least 1.")
        signals = InputSignals(inputs or {}, self._meta["inputs"])
        values = np.empty((steps // every + 1, len(self._meta["sensors"])))
        values[0] = self._sensor_values()
        instants = [int(k) * every for k in accuracy.instants(len(values))]
        looks = instants if look or self.bending.watches else []
        seen = [self.state.q] if look else []
        done, wall, chunk, before = 0, 0.0, every, self.report
        with progress_for(progress) as bar, self._inputs(signals, t0, t0 + steps * h, 1e-6 * h) as table_of:
            while done < steps:
                ahead = [k - done for k in looks if k > done]
                n = min(chunk, steps - done, *ahead[:1])
                table = table_of(t0 + h * np.arange(done + 1, done + n + 1, dtype=float))
                part = values[done // every + 1 : (done + n) // every + 1]
                begin = time.perf_counter()
                try:
                    self.instance.run(h, n, table, every, part)
                except KernelError as error:
                    good = round((self.time - t0) / h) // every + 1
                    raise self._error(
                        f"The step from t = {self.time:g} s with h = {h:g} s failed",
                        error,
                        self._trajectory(t0, h * every, values[:good], wall + time.perf_counter() - begin, before),
                    ) from error
                spent = time.perf_counter() - begin
                wall += spent
                done += n
                if ahead and n == ahead[0]:
                    q = self.state.q
                    self.bending.look(self.time, q)
                    if look:
                        seen.append(q)
                bar.update(done / steps)
                chunk = _next_chunk(chunk, spent, every)
        return self._trajectory(t0, h * every, values, wall, before), seen

    def _warn_once(self) -> None:
        """The part of `simulate`'s check that costs nothing."""
        if self._warned or self.instance.energy_balance() <= accuracy.WRONG_BALANCE:
            return
        driven = len(self.system.arrays["gterm_row"]) > 0
        if accuracy.balance_says(self.report, self.settings.method, driven):
            self._warned = True
            text = f"{accuracy.balance_text(self.report)} The result is wrong from before t = {self.time:g} s."
            warnings.warn(f"{text} Shorter steps make it right.", AccuracyWarning, stacklevel=3)

    def change_settings(self, settings: Settings) -> None:
        """Solve the steps from now on in another way."""
        self.instance.set_settings(**settings.kernel_fields())
        self.settings = settings

    def save(self) -> bytes:
        """All that continues bit for bit, in this or another process."""
        return self.instance.save()

    def restore(self, state: bytes) -> None:
        """Continue from a saved state of the same System."""
        self._call("The saved state was refused", lambda: self.instance.restore(state))

    def _sensor_values(self) -> NDArray[np.float64]:
        return np.array(self.instance.sensors(), float)

    @contextmanager
    def _inputs(
        self, signals: InputSignals, t0: float, t_end: float, tolerance: float
    ) -> Iterator[Callable[[NDArray[np.float64]], NDArray[np.float64] | None]]:
        """Inputs of a run: a table at the ends of its steps, or the kernel asks at the times of its stages."""
        if self.settings.looks_at_ends:
            yield lambda t: self._input_table(signals, t, tolerance)
            return
        signals.attach(self.instance, t0, t_end, tolerance)
        try:
            yield lambda t: None
        finally:
            self.instance.set_input_function(None)

    def _input_table(
        self, signals: InputSignals, t: NDArray[np.float64], tolerance: float
    ) -> NDArray[np.float64] | None:
        """Values (n, nu) of all inputs at the ends of the steps; None keeps them as they are."""
        columns = signals.columns()
        if not columns:
            return None
        table = np.tile([self.instance.get_input(i) for i in range(len(self._meta["inputs"]))], (len(t), 1))
        table[:, columns] = signals.at(t, tolerance)
        return table

    def _trajectory(
        self, t0: float, interval: float, values: NDArray[np.float64], wall: float, before: Report
    ) -> Trajectory:
        sensors, report = self._meta["sensors"], self.report
        t = t0 + interval * np.arange(len(values), dtype=float)
        return Trajectory(
            t,
            values,
            [s["name"] for s in sensors],
            [s["unit"] for s in sensors],
            report,
            self.settings,
            wall,
            accuracy.free_part(report, report.steps - before.steps, report.halvings - before.halvings),
            notices=notices_of(sensors, t, values),
            branch_change=self.branch_change,
        )

    def failure(self, what: str, error: KernelError, trajectory: Trajectory | None = None) -> SimulationError:
        """What the kernel refused, in words, with what was recorded until then."""
        return self._error(what, error, trajectory)

    def _index(self, kind: str, name: str) -> int:
        names = [entry["name"] for entry in self._meta[kind]]
        if name not in names:
            raise ValueError(
                f"There is no {SINGULAR.get(kind, kind[:-1])} {name!r}; the System has: {', '.join(names) or 'none'}."
            )
        return names.index(name)

    def _call(self, what: str, action: Callable[[], object]) -> None:
        try:
            action()
        except KernelError as error:
            raise self._error(what, error) from error

    def _error(self, what: str, error: KernelError, trajectory: Trajectory | None = None) -> SimulationError:
        report = self.instance.report()
        message = f"{what}: {error.message}"
        if error.status in (Status.WRONG_METHOD, Status.NO_TREE):
            if error.status == Status.NO_TREE:
                message += f" Here {self._meta['report']['no_tree']}."
            message += f" The method is {self.settings.method!r}; 'ali3p' takes every System."
            return SimulationError(message, self.time, error.status, trajectory)
        if error.status == Status.BELOW_ROAD:
            message += f" {self.instance.start_lift():.3g} m higher (z of the pose) it would be clear of it."
            return SimulationError(message, self.time, error.status, trajectory)
        if error.status == Status.TOO_STIFF:
            rate = report["fastest_rate"]
        if error.status == Status.TOO_STIFF and rate > 0.0:
            times = f"{rate:.3g} 1/s, which times the step of {self._tried:g} s is {rate * self._tried:.3g}"
            message += (
                f" Its rate here is {times}; that should be below about {STIFF_STEP:g}. Implicit methods "
                "('ali3p', 'radau_5') need not follow it."
            )
        # neither row nor balance is at fault where nothing was solved yet, or all was but did work
        if not report["factorizations"] or error.status in (Status.UNRESOLVED, Status.TOO_STIFF, Status.TOO_FAR):
            return SimulationError(message, self.time, error.status, trajectory)
        worst = open_row(report, [row["name"] for row in self._meta["rows"]])
        if worst:
            message += f" Worst constraint: {worst}."
        if self.settings.tolerance_r < report["residual"] < math.inf:
            name = self._meta["coordinates"][int(report["worst_coordinate"])]
            message += f" Worst balance: {name!r}, residual {report['residual']:.3g}."
        return SimulationError(message, self.time, error.status, trajectory)


_PREPARED: WeakKeyDictionary[System, tuple[LoadedSystem, dict[str, Any]]] = WeakKeyDictionary()


def prepared(system: System) -> tuple[LoadedSystem, dict[str, Any]]:
    """What all Simulations of a System share: it in the kernel's memory, and its names, which nobody may change."""
    if system not in _PREPARED:
        _PREPARED[system] = LoadedSystem(system.to_bytes()), system.meta
    return _PREPARED[system]


def simulate(
    system: System,
    t_end: float,
    h: float | None = None,
    inputs: Mapping[str, Signal] | None = None,
    settings: Settings | None = None,
    parameters: Mapping[str, float] | None = None,
    *,
    every: int = 1,
    progress: bool | Callable[[float], None] | None = None,
    t0: float = 0.0,
    pose: Pose | None = None,
    method: str | None = None,
    estimate_error: bool | None = None,
    tolerance: float | None = None,
    times: ArrayLike | None = None,
) -> Trajectory:
    """Run a System from `t0` to `t_end`, in equal steps or to a tolerance, and warn where the result is not what was
    asked for.

    Parameters
    ----------
    system : System
        What `compile` made.
    t_end : float
        Time at which to stop, s; when h does not divide the duration, the last step ends less than h before it.
    h : float, optional
        Step, s. With a tolerance: interval of the record, by default a 200th of the run. Without h and tolerance a step
        is chosen whose run errs by less than 1e-3 of the model's length (`Trajectory.control` says which).
    inputs : mapping of str to signal, optional
        Per input a constant, a function of time, or a pair (times, values). The trapezoidal rule and generalised-alpha
        use the value at the end of a step, the other methods those at the times of their stages; where a table jumps,
        a step that begins there the value behind the jump, one that ends there the value before it. With a
        tolerance the points of tables are ends of steps; a function is taken as smooth.
    settings : Settings, optional
        How steps are solved. With a tolerance `tolerance_r` and `tolerance_phi` are tightened as far as it needs.
    parameters : mapping of str to float, optional
        Values that differ from their declaration.
    every : int
        Record the state after every that many steps, or intervals of the record.
    progress : bool or callable, optional
        None shows a bar when the run takes longer than two seconds, True at once, False never; a function receives the
        share that is done. A repeat belongs to the run: where it becomes necessary the share goes back once.
    t0 : float
        First time, s.
    pose : Pose, optional
        Start of a scene that is not tied to the ground.
    method : str, optional
        Name of the method, see `Settings`; in place of the one that `settings` names. "auto" takes the one that suits
        System and tolerance best; so does a tolerance without a method.
    estimate_error : bool, optional
        Whether to repeat the run with half the step, from which `Trajectory.accuracy` has the error of the sensors.
        None repeats what the books of energy, halvings or predictors make suspect; the others cost nothing more. False
        checks nothing. Functions among `inputs` are called anew in a repeat, so they must depend on time alone.
    tolerance : float, optional
        Largest accepted error of positions over the whole run, in parts of the model's length (`Model(length=...)`, or
        the extent of the drawing); velocities in the same parts over the time scale of the motion. Steps are then
        chosen by the kernel, the error is estimated by a second run, and `Trajectory.control` says what was done.
    times : array_like, optional
        Instants to record at in place of h, s, ascending, with a tolerance; t0 is recorded too.

    Returns
    -------
    Trajectory
        Sensor values at t0, t0 + every h, ...; of the steps asked for, also after a repeat.

    Raises
    ------
    SimulationError
        When a step fails; its `trajectory` holds what was recorded.

    Warns
    -----
    AccuracyWarning
        When constraint forces did more than 3.6 % of the work in the motion, or the repeat says that positions,
        lengths, angles or forces of elements are off by more than 5 % of the largest range in their unit; with a
        tolerance, when the error is estimated to be more than ten times that.
    BendingWarning
        When a flexible body bends more within its floating frame than its modes hold for.
    BranchWarning
        When a closed loop changed its assembly mode; once, with the names of its joints and the time.
    """
    if h is not None:
        _check_step(h)
    if estimate_error not in (None, True, False):
        raise ValueError(f"estimate_error = {estimate_error!r}; it must be True, False or None (suspects only).")
    if every < 1:
        raise ValueError(f"every = {every}; it must be at least 1.")
    if times is not None and tolerance is None:
        raise ValueError("times need a tolerance: equal steps are recorded where they end.")
    wanted = None if tolerance is None else checked_tolerance(tolerance)
    settings = settings or Settings()
    named = method is not None or settings.method != Settings().method
    chosen = method if method is not None else settings.method if named or wanted is None else "auto"
    if chosen not in ("auto", settings.method):
        settings = replace(settings, method=chosen)
    given = inputs or {}
    declared = prepared(system)[1]["inputs"]
    signals = InputSignals(given, declared)
    names = [declared[i]["name"] for i in signals.columns()]

    def start(step: float = 0.0, used: Settings = settings) -> Simulation:
        first = signals.at(np.array([t0]), 1e-6 * step, after_jump=True)[0]
        return Simulation(
            system,
            settings=used,
            inputs=dict(zip(names, first.tolist(), strict=True)),
            parameters=parameters,
            pose=pose,
            t0=t0,
        )

    def equal_steps(step: float, used: Settings, estimate: bool | None) -> Trajectory:
        return _equal_steps(system, lambda h: start(h, used), t0, t_end, step, inputs, every, progress, estimate)

    if wanted is None and h is not None and chosen != "auto":
        run = equal_steps(h, settings, estimate_error)
        _warn_of(run)
        return run
    from mbs import chosen_run  # only here, since it makes Simulations

    if wanted is None:
        run = chosen_run.equal_steps(
            start, equal_steps, t0, t_end, h, given, settings, chosen, estimate_error, progress
        )
        _warn_of(run)
        return run
    with progress_for(progress) as bar:
        record = chosen_run.record_times(t0, t_end, h, every, times)
        return chosen_run.to_tolerance(start, wanted, record, given, settings, chosen, bar)


def _equal_steps(
    system: System,
    start: Callable[[float], Simulation],
    t0: float,
    t_end: float,
    h: float,
    inputs: Mapping[str, Signal] | None,
    every: int,
    progress: bool | Callable[[float], None] | None,
    estimate_error: bool | None,
) -> Trajectory:
    """A run in steps of h, with a repeat where its accuracy asks for one."""
    made: list[Simulation] = []

    def march(step: float, every: int, progress: Callable[[float], None], look: bool) -> repeat.Run:
        simulation = start(step)
        made.append(simulation)
        return simulation._march(t_end, step, inputs, every, progress, look)

    checked = estimate_error is not False
    look = checked and not accuracy.has_motion_sensor(system)
    often = accuracy.recorded_every(every, _count_steps(t0, t_end, h)) if checked else every
    try:
        with progress_for(progress) as bar:
            first = 1.0 / 3.0 if estimate_error else 1.0
            run = march(h, often, lambda share: bar.update(first * share), look)
            found = run[0].accuracy
            if checked:
                found = repeat.check(system, run, march, h, often, bar.update, estimate_error is True)
    except SimulationError as error:
        if error.trajectory is not None:
            error.trajectory = error.trajectory.thinned(every // often)
        raise
    finally:  # of the run that was asked for, also when it failed
        if made and made[0].branch_change:
            warnings.warn(made[0].branch_change, BranchWarning, stacklevel=4)
        if made:
            made[0].bending.warn(stacklevel=5)
    trajectory = run[0].thinned(every // often)
    trajectory.accuracy = found
    return trajectory


def _warn_of(run: Trajectory) -> None:
    if run.accuracy is not None and run.accuracy.message:
        warnings.warn(run.accuracy.message, AccuracyWarning, stacklevel=3)


def notices_of(sensors: list[dict[str, str]], t: NDArray[np.float64], values: NDArray[np.float64]) -> list[str]:
    """What sensors with a notice want told of their columns."""
    told = []
    for k, sensor in enumerate(sensors):
        there = np.flatnonzero(values[:, k] if "notice" in sensor else ())
        if len(there):
            most = values[np.argmax(np.abs(values[:, k])), k]
            told.append(
                f"{sensor['notice']}: '{sensor['name']}' is not 0 from t = {t[there[0]]:g} s, "
                f"at most {most:g} {sensor['unit']}."
            )
    return told


def _check_step(h: float) -> None:
    if not (math.isfinite(h) and h > 0.0):
        raise ValueError(f"The step h is {h} s; it must be positive and finite.")


def check_end(t0: float, t_end: float) -> None:
    """One sentence for an end that is none."""
    if not (math.isfinite(t_end) and t_end >= t0):
        raise ValueError(f"The end t_end is {t_end} s; it must be finite and not before {t0:g} s.")


def _count_steps(t0: float, t_end: float, h: float) -> int:
    """Number of whole steps that end not after `t_end`, give or take round-off."""
    check_end(t0, t_end)
    return math.floor((t_end - t0) / h + 1e-6)


def _next_chunk(chunk: int, spent: float, every: int) -> int:
    """Steps of the next call, a multiple of `every`, for about CHUNK_SECONDS."""
    factor = min(8.0, CHUNK_SECONDS / max(spent, 1e-9))
    return max(1, int(chunk * factor / every)) * every
