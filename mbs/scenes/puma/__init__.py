"""The PUMA 560 whose hand is pinned to the ground and released while it moves (paper, section 3.2)."""

from collections.abc import Iterator
from dataclasses import dataclass
from importlib.resources import files

import numpy as np
from numpy.typing import NDArray

from mbs.model.model import Model
from mbs.results.trajectory import Trajectory
from mbs.scenes.puma.robot_data import FOREARM_EXCESS, GRAVITY, HAND_POINT, LINKS, STAGES_S, START_DEG, frames
from mbs.settings.settings import Settings
from mbs.simulation.stepping import Simulation
from mbs.system.system import System

PIN = "hand"
TORQUES = tuple(f"torque.{k}" for k in range(1, 7))


def build() -> Model:
    """Six links on revolutes with relative angles, armature inertias and motor torques; a pin for the hand point, off.

    At rest at the start of the manoeuvre, gravity along -z.
    """
    m = Model("PUMA 560", dimension=3, gravity=(0.0, 0.0, -GRAVITY))
    m.stop_time = sum(STAGES_S)
    parent = m.ground
    pose, links = frames(START_DEG), []
    for k, link in enumerate(LINKS):
        (base, origin), (R, p) = pose[k], pose[k + 1]
        body = m.body(link.name, mass=link.mass, com=p + R @ link.com, inertia=R @ np.diag(link.inertia) @ R.T)
        axis = base[:, 2]
        m.revolute(f"joint {k + 1}", parent, body, point=origin, axis=axis)
        angle = m.relative_angle(f"angle.{k + 1}", parent, body, axis=axis, zero=float(np.deg2rad(START_DEG[k])))
        m.armature(f"motor {k + 1}", angle, inertia=link.armature)
        torque = m.input(
            TORQUES[k], start=float(_table()[0, 2 + k]), unit="N m", description=f"torque at joint {k + 1}"
        )
        m.torque_on(f"torque {k + 1}", angle, input=torque)
        m.sense_coordinate(f"angle.{k + 1}", angle, description=f"angle of joint {k + 1}")
        parent = body
        links.append(body)
    shoulder = m.relative_angle(
        "forearm against waist",
        links[0],
        links[2],
        axis=pose[1][0][:, 2],
        zero=float(np.deg2rad(START_DEG[1] + START_DEG[2])),
    )
    m.armature("forearm excess", shoulder, inertia=FOREARM_EXCESS)
    R, p = pose[-1]
    hand = p + R @ HAND_POINT
    m.pin(PIN, parent, hand)
    for component in "xyz":
        m.sense_position(
            f"hand.position.{component}", parent, hand, component, description=f"position of the hand along {component}"
        )
    m.sense_energy("energy.total", "total", description="kinetic and potential energy")
    return m


@dataclass(frozen=True)
class Replay:
    """Result of a replay of the manoeuvre."""

    times: NDArray[np.float64]
    """Shape (n,): s; the switch times appear twice."""
    hand: NDArray[np.float64]
    """Shape (n, 3): m."""
    jumps_J: tuple[float, float]
    """Change of the kinetic energy when the pin closed and when it opened."""

    @property
    def error(self) -> float:
        """Distance between the first and the last position of the hand, m: the paper's measure."""
        return float(np.linalg.norm(self.hand[-1] - self.hand[0]))

    def path_error(self) -> float:
        """Largest distance of the hand, at the times of the table, from the path to which the torques belong, m."""
        table = _table()
        expected = np.column_stack([np.interp(self.times, table[:, 1], table[:, k]) for k in (8, 9, 10)])
        on_table = np.abs(self.times * 100.0 - np.round(self.times * 100.0)) < 1e-6
        return float(np.linalg.norm(self.hand - expected, axis=1)[on_table].max())


def replay(
    system: System,
    h: float | tuple[float, float, float],
    settings: Settings | None = None,
    estimate_error: bool | float | None = None,
) -> Replay:
    """Replay the manoeuvre with the torques of the table: 2 s from rest to rest, 4 s with the hand pinned, 2 s back.

    `system`: compiled model of `build`; `h`: one step or one for each stage, s; `estimate_error`: as in
    `Simulation.run`. Raises `SimulationError` if a step fails.
    """
    jumps: list[float] = []
    runs = list(stages(Simulation(system, settings=settings), h, jumps, estimate_error))
    hand = [np.column_stack([run[f"hand.position.{c}"] for c in "xyz"]) for run in runs]
    return Replay(np.concatenate([run.t for run in runs]), np.concatenate(hand), (jumps[0], jumps[1]))


def stages(
    simulation: Simulation,
    h: float | tuple[float, float, float],
    jumps: list[float] | None = None,
    estimate_error: bool | float | None = None,
) -> Iterator[Trajectory]:
    """Run the three stages of the replay, one after the other.

    Parameters
    ----------
    simulation : Simulation
        Of the System of `build`, at its start.
    h : float or tuple of float
        s; one step, or one for each stage.
    jumps : list, optional
        Takes the change of the kinetic energy when the pin closes and when it opens, J.
    estimate_error : bool or float, optional
        As in `Simulation.run`.

    Yields
    ------
    Trajectory
    """
    table, end = _table(), 0.0
    steps = h if isinstance(h, tuple) else (h,) * len(STAGES_S)
    for stage, (duration, step) in enumerate(zip(STAGES_S, steps, strict=True), start=1):
        rows = table[table[:, 0] == stage]
        if stage > 1:
            for name, value in zip(TORQUES, rows[0, 2:8].tolist(), strict=True):
                simulation.set_input(name, value)
            jump = simulation.set_switch(PIN, stage == 2)
            if jumps is not None:
                jumps.append(jump)
        end += duration
        inputs = {name: (rows[:, 1], rows[:, 2 + k]) for k, name in enumerate(TORQUES)}
        yield simulation.run(end, step, inputs=inputs, progress=False, estimate_error=estimate_error)


def pinned_position() -> NDArray[np.float64]:
    """Position of the pinned hand on the path for which the torques were computed, m, shape (3,)."""
    table = _table()
    return np.array(table[table[:, 0] == 2][0, 8:11])


def _table() -> NDArray[np.float64]:
    """Table of stage, time, s, six torques, N m, and position of the hand, m; shape (804, 11)."""
    text = files("mbs.scenes.puma").joinpath("manoeuvre.csv").read_text(encoding="utf-8")
    return np.array([[float(v) for v in line.split(",")] for line in text.splitlines()[1:]])
