"""Stepping a System by hand."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import astuple

import numpy as np

from mbs import accuracy
from mbs.accuracy import AccuracyWarning
from mbs.input_signals import InputSignals, Signal, unit_text
from mbs.kernel.binding import Instance, KernelError
from mbs.large_bending import BendingWatch
from mbs.run_report import Report
from mbs.settings import Settings
from mbs.simulation.arguments import check_step
from mbs.simulation.march import march
from mbs.simulation.prepared_system import prepared
from mbs.simulation.refusal import refusal
from mbs.simulation.state import Pose, State
from mbs.system import System
from mbs.trajectory import Trajectory

SINGULAR = {"switches": "switch"}


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
        self._warned, self.step_tried = False, 0.0  # whether it has warned, the last step tried
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

    @property
    def time(self) -> float:
        """Time of the state, s."""
        return float(self.instance.time)

    @property
    def sensors(self) -> dict[str, float]:
        """Sensor values at the state, by name."""
        return {s["name"]: v for s, v in zip(self._meta["sensors"], self.instance.sensors(), strict=True)}

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
        check_step(h)
        self.step_tried = h
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
        trajectory = march(self, t_end, h, inputs, every, progress)[0]
        self._warn_once()
        self.bending.warn(stacklevel=3)
        return trajectory

    def march(self, t_end: float, h: float, inputs: Mapping[str, Signal]) -> Trajectory:
        """As `run`, without a word about the accuracy: for who compares runs himself."""
        return march(self, t_end, h, inputs, 1, False)[0]

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
            raise refusal(self, what, error) from error
