"""Random machines with events: belts with stick-slip, brakes, backlash, cams that lift off, impacts, stops."""

import itertools
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, PPoly

import mbs
from benchmarks.references.masses_on_a_line import Cam, Friction, Link, Machine
from mbs.elements import CoordinateFriction, EndStops, SpringDamper

Array = NDArray[np.float64]


def random_machine(rng: np.random.Generator) -> tuple[str, Machine]:
    """The kind of a random machine, and the machine."""
    kind = str(rng.choice(list(KINDS)))
    return kind, KINDS[kind](rng)


def model_of(d: Machine) -> mbs.Model:
    """Model of the engine of a machine."""
    m = mbs.Model("random", dimension=2, gravity=(d.pull, 0.0))
    bodies = [
        m.point_mass(f"b{i}", mass=k, position=(x, 0.0)) for i, (k, x) in enumerate(zip(d.masses, d.start, strict=True))
    ]
    for i, body in enumerate(bodies):
        m.point_on_line(f"line{i}", (body, None), (m.ground, (d.start[i], 0.0)), axis=(1.0, 0.0))
        if i in d.driven:
            cam = d.driven[i]
            guide = m.guide_time(f"time{i}", cam.curve, unit="m" if cam.table is None else "rad")
            if cam.table is not None:
                guide = m.guide_table(f"lift{i}", guide, cam.table, unit="m")
            m.drive(f"drive{i}", body.point()[0], guide)
        else:
            m.initial_velocity(body, linear=(d.speeds[i], 0.0))
            m.sense_position(f"x{i}", body, None, "x")
    for i, k in enumerate(d.links):
        a, b = (bodies[e].point() if isinstance(e, int) else m.ground.point((e, 0.0)) for e in k.ends)
        stops = EndStops(*k.low, *k.high, bump_loss=k.loss, rebound_loss=k.loss)
        m.add(SpringDamper(k.stiffness, k.damping, k.length, stops).record(f"link{i}", b - a))
    for i, f in enumerate(d.frictions):
        slide = bodies[f.mass].point()[0] if f.on is None else bodies[f.mass].point()[0] - bodies[f.on].point()[0]
        m.add(CoordinateFriction(f.largest, f.stiffness, f.damping, "N").record(f"friction{i}", slide))
    return m


def _mass(rng: np.random.Generator) -> float:
    return float(10.0 ** rng.uniform(-0.5, 1.0))


def _stiffness(rng: np.random.Generator, mass: float, low: float, high: float) -> float:
    """Stiffness, N/m, with which a mass, kg, has a random frequency between two limits, Hz."""
    return mass * (2.0 * np.pi * low * float((high / low) ** rng.uniform())) ** 2


def _friction(rng: np.random.Generator, mass: int, on: int | None, kg: float) -> Friction:
    largest = kg * 9.81 * float(rng.uniform(0.05, 0.6))
    stiffness = largest / float(10.0 ** rng.uniform(-3.5, -2.0))
    return Friction(mass, on, largest, stiffness, float(rng.uniform(0.4, 2.0)) * float(np.sqrt(stiffness * kg)))


def _random_oscillation(rng: np.random.Generator, position: float, span: float) -> Cam:
    """A random oscillation about a position, m, from rest. `span`: s."""
    t = np.linspace(0.0, span, int(span * rng.uniform(6.0, 24.0)))
    swing = float(rng.uniform(0.01, 0.1)) * rng.uniform(-1.0, 1.0, len(t))
    swing[0] = 0.0
    return Cam(CubicSpline(t, position + swing, bc_type="clamped"))


def belt(rng: np.random.Generator) -> Machine:
    """A mass on a spring and on a belt with constant acceleration."""
    kg, span = _mass(rng), float(rng.uniform(1.0, 3.0))
    speed, growth = rng.uniform(-1.0, 1.0, 2)
    drive = Cam(PPoly(np.array([0.5 * growth, speed, 0.0])[:, None], [0.0, 2.0 * span]))
    spring = Link((-1.0, 0), _stiffness(rng, kg, 0.5, 4.0), 0.0, 1.0)
    start, rate = float(rng.uniform(-0.2, 0.2)), float(rng.uniform(-1.0, 1.0))
    pad = _friction(rng, 0, 1, kg)
    return Machine([kg, 1.0], [start, 0.0], [rate, 0.0], [spring], [pad], {1: drive}, span=span)


def brake(rng: np.random.Generator) -> Machine:
    """Two masses on a slope, connected by a spring, one or both braked."""
    kg = [_mass(rng), _mass(rng)]
    link = Link((0, 1), _stiffness(rng, min(kg), 1.0, 10.0), float(rng.uniform(0.0, 0.5)) * min(kg), 1.0)
    pads = [_friction(rng, i, None, sum(kg)) for i in range(int(rng.integers(1, 3)))]
    speeds = rng.uniform(0.2, 3.0, 2)
    return Machine(kg, [0.0, 1.0], list(speeds), [link], pads, pull=float(rng.uniform(0.0, 3.0)))


def play(rng: np.random.Generator) -> Machine:
    """A mass moved by another one with backlash."""
    kg, span = _mass(rng), float(rng.uniform(1.0, 2.0))
    gap, k = float(10.0 ** rng.uniform(-3.0, -1.3)), _stiffness(rng, kg, 5.0, 40.0)
    fork = Link((0, 1), 0.0, float(rng.uniform(0.0, 2.0)) * kg, 0.0, (1.0 - gap, k), (1.0 + gap, k))
    back = Link((1, 3.0), _stiffness(rng, kg, 0.3, 2.0), 0.0, 2.0)
    return Machine(
        [1.0, kg], [0.0, 1.0], [0.0, 0.0], [fork, back], (), {0: _random_oscillation(rng, 0.0, span)}, span=span
    )


def cam(rng: np.random.Generator) -> Machine:
    """A follower that a spring presses on a cam and that may lift off."""
    kg, span, turns = _mass(rng), float(rng.uniform(0.5, 1.5)), float(rng.uniform(1.0, 6.0))
    angles = np.sort(rng.uniform(0.15, 0.95, 4))
    lifts = np.concatenate([[0.0], float(rng.uniform(0.005, 0.05)) * rng.uniform(0.0, 1.0, 4)])
    rounds = int(turns * span) + 2
    table = np.array(
        [(2.0 * np.pi * (r + a), z) for r in range(rounds) for a, z in zip([0.0, *angles], lifts, strict=True)]
    )
    shaft = Cam(PPoly(np.array([2.0 * np.pi * turns, 0.0])[:, None], [0.0, 2.0 * span]), table)
    contact = _stiffness(rng, kg, 15.0, 60.0)
    spring, stretch = _stiffness(rng, kg, 1.0, 5.0), float(rng.uniform(0.01, 0.1))
    links = [
        Link((0, 1), 0.0, 0.0, 0.0, (1.0, contact), loss=float(rng.uniform(0.0, 0.3))),
        Link((1, 2.0), spring, 0.0, 1.0 + stretch),
    ]
    rest = 1.0 - spring * stretch / (contact + spring)
    return Machine([1.0, kg], [0.0, rest], [0.0, 0.0], links, (), {0: shaft}, span=span)


def impact(rng: np.random.Generator) -> Machine:
    """Masses in a row between two walls."""
    n = int(rng.integers(1, 4))
    kg = [_mass(rng) for _ in range(n)]
    positions = np.cumsum(1.0 + rng.uniform(0.02, 0.3, n + 1))
    ends = [0.0, *range(n), float(positions[-1])]
    k = [_stiffness(rng, min(kg), 5.0, 40.0) for _ in range(n + 1)]
    loss = float(rng.choice([0.0, rng.uniform(0.0, 0.5)]))
    links = [Link(pair, low=(1.0, s), loss=loss) for pair, s in zip(itertools.pairwise(ends), k, strict=True)]
    speeds = list(rng.uniform(-1.5, 1.5, n))
    return Machine(kg, list(positions[:n]), speeds, links, pull=float(rng.choice([0.0, rng.uniform(-9.81, 9.81)])))


def stop(rng: np.random.Generator) -> Machine:
    """A mass with spring, damper and stops on a moving base."""
    kg, span = _mass(rng), float(rng.uniform(1.0, 2.0))
    soft = _stiffness(rng, kg, 1.0, 4.0)
    travel = rng.uniform(0.005, 0.05, 2)
    hard = [float(x) for x in soft * 10.0 ** rng.uniform(0.5, 2.0, 2)]
    strut = Link(
        (0, 1), soft, float(rng.uniform(0.0, 0.4)) * float(np.sqrt(soft * kg)), 1.0,
        (1.0 - float(travel[0]), hard[0]), (1.0 + float(travel[1]), hard[1]), float(rng.uniform(0.0, 0.3)),
    )  # fmt: skip
    speed = float(rng.uniform(-1.0, 1.0))
    return Machine(
        [1.0, kg], [0.0, 1.0], [0.0, speed], [strut], (), {0: _random_oscillation(rng, 0.0, span)}, span=span
    )


KINDS: dict[str, Callable[[np.random.Generator], Machine]] = {
    "belt": belt,
    "brake": brake,
    "play": play,
    "cam": cam,
    "impact": impact,
    "stop": stop,
}
