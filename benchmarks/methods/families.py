"""Families of random cases: a function for each, which returns a random model with its exact motion."""

import atexit
import shutil
import tempfile
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from fmpy import platform
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.interpolate import PPoly

import mbs
from benchmarks.methods import chaotic_pendulums, random_cars, random_machines, random_mechanisms
from benchmarks.references import boxes, masses_on_a_line, newton_euler
from benchmarks.references.newton_euler import INSTANTS
from benchmarks.references.rigid_mechanism import GROUND, Joint, Mechanism
from fmu_src.build.build import build_fmu
from hosts.fmu.built_fmu import fmu_of_car
from hosts.fmu.fmu import Fmu, StepRefusedError
from mbs.elements import ContactPoints, EndStops, SpringDamper
from mbs.elements.road import PlaneRoad
from mbs.flexible import Beam, Frame, Interface, Material, ReducedBody, craig_bampton
from mbs.flexible.section import tube
from mbs.kernel.header.enumerations import Status

Array = NDArray[np.float64]
STEPS = (0.001, 0.002, 0.005, 0.01, 0.02)  # s
CHAOTIC_STEPS = (0.0002, 0.0005, 0.001, 0.002)  # s
TOLERANCES = (1e-2, 1e-3, 1e-4)
NEARLY_FLAT = (1e-5, 1e-3)  # relative difference of the arms near a change point


@dataclass(frozen=True)
class CaseRun:
    """The result of a run of a case."""

    values: Mapping[str, Array]
    """Values by sensor, at the instants."""
    estimate: float | None
    """Estimate of the error, relative to the range or the length."""
    cost: float | None = None
    """Number of steps of the run and of its check, divided by the number of steps of the run."""
    method: str = ""


@dataclass(frozen=True)
class Case:
    """A System with its simulation and its exact motion."""

    kind: str
    system: mbs.System
    reference: Mapping[str, Array]
    """Exact values by compared sensor at equal instants of the run, (n,) each."""
    span: float
    """Duration, s."""
    run: Callable[..., CaseRun]
    """Called with ``h`` and ``every``, or with ``tolerance`` and ``times``; raises `mbs.SimulationError`."""
    steps: tuple[float, ...] = STEPS
    tolerances: tuple[float, ...] = TOLERANCES


def simulation_fields(
    system: mbs.System, span: float, run: Callable[..., mbs.Trajectory] | None = None
) -> dict[str, Any]:
    """Arguments of a `Case` that is run by `mbs.simulate`, or by another function with the same arguments."""

    def case_run(h: float | None = None, **more: Any) -> CaseRun:
        trajectory = (run or partial(mbs.simulate, system, span, progress=False))(h=h, **more)
        if trajectory.control is not None:
            return CaseRun(trajectory, trajectory.control.error, None, trajectory.control.method)
        accuracy = trajectory.accuracy
        return CaseRun(
            trajectory, accuracy.error if accuracy else None, 1.0 + accuracy.check_cost if accuracy else None
        )

    return {"system": system, "span": span, "run": case_run}


def _mechanism_case(kind: str, mechanism: Mechanism) -> Case:
    names = [f"tip{i}.{c}" for i in range(len(mechanism.links)) for c in "xyz"[: mechanism.dimension]]
    motion = newton_euler.motion(mechanism)
    reference = dict(zip(names, motion.reshape(len(motion), -1).T, strict=True))
    system = mbs.compile(random_mechanisms.model_of(mechanism))
    return Case(kind, reference=reference, **simulation_fields(system, mechanism.span))


def planar(rng: np.random.Generator) -> Case:
    """Closed loops and chains in the plane."""
    return _mechanism_case(*random_mechanisms.random_mechanism(rng, 2))


def spatial(rng: np.random.Generator) -> Case:
    """Random spatial mechanisms."""
    return _mechanism_case(*random_mechanisms.random_mechanism(rng, 3))


def machines(rng: np.random.Generator) -> Case:
    """Masses on a line with belts, brakes, backlash, cams, impacts and stops."""
    kind, machine = random_machines.random_machine(rng)
    positions = masses_on_a_line.motion(machine)
    reference = {f"x{i}": positions[:, i] for i in range(len(machine.masses)) if i not in machine.driven}
    system = mbs.compile(random_machines.model_of(machine))
    return Case(kind, reference=reference, **simulation_fields(system, machine.span))


def cars(rng: np.random.Generator) -> Case:
    """Cars over kerbs, and dropped cars, with all spring and tyre forces."""
    drive = random_cars.random_drive(rng)
    kind = f"{drive.car} {drive.step:g} m, {drive.speed:.1f} m/s"

    def run(h: float | None = None, **more: Any) -> mbs.Trajectory:
        return drive.run("auto" if h is None else "ali3p", h, **more)

    simulation = simulation_fields(drive.system, drive.span, run)
    return Case(kind, reference=drive.reference(), **simulation, steps=random_cars.STEPS, tolerances=TOLERANCES[:2])


def boxes_case(rng: np.random.Generator) -> Case:
    """Boxes that fall and tumble on their corners without friction."""
    mass, half = float(50.0 ** rng.uniform()), rng.uniform(0.1, 0.6, 3)
    onset, depth = float(10.0 ** rng.uniform(-2.7, -2.0)), float(10.0 ** rng.uniform(-3.0, -2.0))
    contact = replace(
        ContactPoints.for_mass(mass / 4.0, depth=depth, onset=onset, loss=float(rng.uniform(0.1, 1.0))),
        friction_factor=0.0,
    )
    falling_box = boxes.Box(
        mass, half, float(np.linalg.norm(half) + rng.uniform(0.01, 0.5)), np.append(rng.normal(0.0, 0.5, 2), -0.5),
        rng.normal(0.0, 3.0, 3), contact.stiffness, onset, contact.loss, 1.0,
    )  # fmt: skip
    reference = boxes.motion(falling_box)
    m = mbs.Model("box", gravity=(0.0, 0.0, -9.81))
    centre = np.array([0.0, 0.0, falling_box.height])
    body = m.body("box", mass=mass, com=centre, inertia=falling_box.inertia)
    m.contact_points("corners", body, centre + falling_box.corners, road=m.road(PlaneRoad()), contact=contact)
    m.initial_velocity(body, linear=falling_box.velocity, angular=falling_box.omega)
    for c in "xyz":
        m.sense_position(f"centre.{c}", body, None, c)
        m.sense_position(f"corner.{c}", body, centre + falling_box.corners[0], c)
    return Case("box", reference=reference, **simulation_fields(mbs.compile(m), falling_box.span))


def _swinging(rng: np.random.Generator) -> tuple[str, Mechanism]:
    """A chain of two or three links, or a four-bar with a pendulum."""
    while True:
        kind = str(rng.choice(["chain", "spatial chain", "four-bar with pendulum"]))
        mechanism = random_mechanisms.KINDS[kind](rng)
        if len(mechanism.links) > 1:
            return kind, mechanism


def jumps(rng: np.random.Generator) -> Case:
    """Mechanisms whose first link is driven with a rate or an acceleration that jumps two to four times."""
    kind, mechanism = _swinging(rng)
    t = np.concatenate(
        [[0.0], np.sort(rng.uniform(0.1, mechanism.span, int(rng.integers(2, 5)))), [2.0 * mechanism.span]]
    )
    scale, jumping = np.sqrt(9.81 / mechanism.size), rng.random() < 0.7
    angle, rate, coefficients = 0.0, float(rng.normal(0.0, 1.0) * scale), []
    for length in np.diff(t):
        acceleration = 0.0 if jumping else float(rng.normal(0.0, 1.0) * scale**2)
        coefficients.append((acceleration, rate, angle))
        angle += (rate + acceleration * length) * length
        rate = float(rng.normal(0.0, 1.0) * scale) if jumping else rate + 2.0 * acceleration * length
    driven_drawing = replace(mechanism, drive=PPoly(np.array(coefficients).T, t), torque=0.0)
    return _mechanism_case(f"{kind}, its {'rate' if jumping else 'acceleration'} jumps", driven_drawing)


def switches(rng: np.random.Generator) -> Case:
    """Chains with a tip that a pin fixes for some time, switched between calls of `Simulation.run`."""
    kind, mechanism = _swinging(rng)
    link = int(rng.integers(1, len(mechanism.links)))
    on, off = (mechanism.span / INSTANTS * k for k in np.sort(rng.choice(np.arange(5, INSTANTS - 5), 2, replace=False)))
    pin = Joint("pin", link, GROUND, mechanism.tips[link], mechanism.joints[0].axis, (on, off))
    mechanism = replace(mechanism, joints=[*mechanism.joints, pin])
    case = _mechanism_case(f"{kind} with a pin", mechanism)
    name = f"j{len(mechanism.joints) - 1}"

    def run(h: float, every: int) -> CaseRun:
        simulation = mbs.Simulation(case.system)
        parts, errors = [], []
        for end, closed in ((on, False), (off, True), (mechanism.span, False)):
            simulation.set_switch(name, closed)
            parts.append(simulation.run(end, h, every=every, progress=False))
            errors.append(parts[-1].accuracy.error if parts[-1].accuracy else None)
        values = {n: np.concatenate([part[n][int(k > 0) :] for k, part in enumerate(parts)]) for n in case.reference}
        return CaseRun(values, max((e for e in errors if e is not None), default=None))

    return replace(case, run=run, tolerances=())


@cache
def _beam(length: float, wall: float) -> ReducedBody:
    nodes = np.column_stack([np.linspace(0.0, length, 5), np.zeros((5, 2))])
    section, material = tube(outer_diameter=0.03, wall=wall), Material(E=70e9, nu=0.33, rho=2700.0)
    frame = Frame(nodes, [Beam(i, i + 1, section, material) for i in range(4)])
    ends = [Interface(4, rotations=True)]
    return craig_bampton(frame.finite_element_model(), reference=0, interfaces=ends, dynamic_modes=4)


def flexible(rng: np.random.Generator) -> Case:
    """Beams on a hinge whose free ends fall on a stop."""
    length = float(rng.choice([1.0, 1.5, 2.0]))
    reduced = _beam(length, float(rng.choice([0.001, 0.002])))
    m = mbs.Model("beam", gravity=(0.0, 0.0, -9.81))
    beam = m.flexible_body("beam", reduced)
    root, tip = beam.interface(0), beam.interface(4)
    m.revolute("hinge", m.ground, root, point=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    gap, height = float(rng.uniform(0.01, 0.3)), 1.0
    stop = EndStops(
        height - gap, float(10.0 ** rng.uniform(3.0, 5.0)), 0.0, 0.0, bump_loss=float(rng.uniform(0.0, 0.5))
    )
    gap_vector = tip.point((length, 0.0, 0.0)) - m.ground.point((length, 0.0, -height))
    m.add(SpringDamper(0.0, 0.0, height, stop).record("stop", gap_vector))
    m.initial_velocity(beam, angular=(0.0, float(rng.uniform(-2.0, 2.0)), 0.0))
    for c in "xz":
        m.sense_position(f"tip.{c}", tip, (length, 0.0, 0.0), c)
    system, span = mbs.compile(m), float(rng.uniform(0.4, 1.0))

    def simulate(method: str, h: float) -> mbs.Trajectory:
        n = round(span / INSTANTS / h)
        return mbs.simulate(
            system, span, span / INSTANTS / n, every=n, method=method, estimate_error=False, progress=False
        )

    reference = random_cars.reference_by_two_methods(system, simulate)
    return Case(
        "beam", reference=reference, **simulation_fields(system, span), tolerances=()
    )  # finer than the reference


def gears(rng: np.random.Generator) -> Case:
    """Two eccentric wheels coupled by gears, or a four-bar through its change point."""
    if rng.random() < 0.5:
        return _mechanism_case("change point", random_mechanisms.four_bar(rng, NEARLY_FLAT))
    masses, inertias, arms = (
        10.0 ** rng.uniform(-0.5, 0.5, 2),
        10.0 ** rng.uniform(-2.0, 0.0, 2),
        rng.normal(0.0, 0.3, 2),
    )
    ratio = float(rng.choice([-1.0, 1.0]) * rng.uniform(1.0, 4.0))
    rate, span = float(rng.normal(0.0, 10.0)), float(rng.uniform(1.0, 3.0))
    gain = np.array([1.0, 1.0 / ratio])  # rate of each wheel relative to the first
    reduced_inertia = float((inertias + masses * arms**2) @ gain**2)

    def rates(_: float, y: Array) -> Array:
        return np.array([y[1], -9.81 * float(masses * arms * gain @ np.cos(gain * y[0])) / reduced_inertia])

    t = np.linspace(0.0, span, INSTANTS + 1)
    angle = solve_ivp(rates, (0.0, span), [0.0, rate], t_eval=t, method="DOP853", rtol=1e-11, atol=1e-12).y[0]
    m = mbs.Model("gears", dimension=2, gravity=(0.0, -9.81))
    angles, reference = [], dict[str, Array]()
    for i, (mass, inertia, arm) in enumerate(zip(masses, inertias, arms, strict=True)):
        wheel = m.body(f"wheel{i}", mass=mass, com=(i + arm, 0.0), inertia=inertia)
        m.revolute(f"bearing{i}", m.ground, wheel, point=(float(i), 0.0))
        angles.append(m.relative_angle(f"angle{i}", m.ground, wheel))
        m.initial_velocity(wheel, linear=(0.0, rate * gain[i] * arm), angular=rate * gain[i])
        for k, c in enumerate("xy"):
            m.sense_position(f"rim{i}.{c}", wheel, (i + 0.2, 0.0), c)
            reference[f"rim{i}.{c}"] = i * (1 - k) + 0.2 * (np.cos, np.sin)[k](gain[i] * angle)
    m.gear("gear", *angles, ratio=ratio)
    return Case("gears", reference=reference, **simulation_fields(mbs.compile(m), span))


def tumbling(rng: np.random.Generator) -> Case:
    """Motions whose sensors are rates, the torque of a motor, and constant or prescribed quantities."""
    if rng.random() < 0.4:
        return _tumbling_body(rng)
    mechanism = random_mechanisms.chain(rng, int(rng.choice([2, 3])))
    while len(mechanism.links) < 2:
        mechanism = random_mechanisms.chain(rng, 2)
    driven = rng.random() < 0.5
    rate = float(rng.uniform(1.0, 6.0))
    drive = PPoly(np.array([[0.2], [rate], [0.0]]), [0.0, 2.0 * mechanism.span]) if driven else None
    mechanism = replace(mechanism, drive=drive, torque=0.0)
    rates = newton_euler.motion(mechanism, rates=True)
    names = [f"rate{i}.{c}" for i in range(len(mechanism.links)) for c in ("z" if mechanism.dimension == 2 else "xyz")]
    reference = dict(zip([*names, "motor.torque"] if driven else names, rates.T, strict=False))
    kind = f"chain in {'the plane' if mechanism.dimension == 2 else 'space'}, {'driven' if driven else 'free'}"
    system = mbs.compile(random_mechanisms.model_of(mechanism, rates=True))
    return Case(kind, reference=reference, **simulation_fields(system, mechanism.span), tolerances=())


def _tumbling_body(rng: np.random.Generator) -> Case:
    """A free body that rotates nearly about its axis of intermediate inertia; its centre of mass rests."""
    moments = np.sort(rng.uniform(0.1, 0.3, 3))
    moments[1:] = np.minimum(moments[1:], [moments[1], 0.95 * (moments[0] + moments[1])])
    turn = np.array([0.01, float(rng.uniform(2.0, 8.0)), 0.01])
    span = float(rng.uniform(5.0, 20.0))

    def rates(_: float, w: Array) -> Array:
        return np.asarray(-np.cross(w, moments * w) / moments)

    t = np.linspace(0.0, span, INSTANTS + 1)
    solution = solve_ivp(rates, (0.0, span), turn, t_eval=t, method="DOP853", rtol=1e-12, atol=1e-13).y
    m = mbs.Model("tumbling body", gravity=(0.0, 0.0, 0.0))
    body = m.body("body", mass=1.0, com=(0.0, 0.0, 0.0), inertia=np.diag(moments))
    m.initial_velocity(body, linear=(0.0, 0.0, 0.0), angular=turn)
    for c in "xyz":
        m.sense_rotation(f"rate.{c}", body, c, order=1)
        m.sense_position(f"centre.{c}", body, None, c)
    reference = {f"rate.{c}": solution[k] for k, c in enumerate("xyz")}
    return Case("body", reference=reference, **simulation_fields(mbs.compile(m), span), tolerances=())


def chaotic(rng: np.random.Generator) -> Case:
    """Double and triple pendulums."""
    system, reference, span = chaotic_pendulums.random_pendulum(rng)
    return Case(
        f"{len(reference) // 2} rods", reference=reference, **simulation_fields(system, span), steps=CHAOTIC_STEPS
    )


def fmus(rng: np.random.Generator) -> Case:
    """FMUs of cars through FMPy, which drive down a kerb or fall, with constant pedals and steering wheel.

    Outputs are compared at each communication step.
    """
    car, falls = str(rng.choice(random_cars.CARS)), rng.random() < 0.5
    pose = {"yaw": float(rng.uniform(-0.6, 0.6)), "speed": float(rng.uniform(3.0, 25.0))}
    pose["z"] = float(rng.uniform(0.05, 0.5)) if falls else 0.0
    road = {} if falls else {"road.kerb_x": 3.0, "road.kerb_height": float(rng.uniform(0.02, 0.12))}
    inputs = {"throttle": 0.3} if rng.random() < 0.5 else {"brake": float(rng.uniform(0.0, 0.6))}
    inputs["steering"] = float(rng.choice([0.0, rng.uniform(-0.3, 0.3)]))
    span = float(round(rng.uniform(1.2, 2.2) / random_cars.INTERVAL) * random_cars.INTERVAL)
    system, step = random_cars.system_of(car, 0.0), float(rng.choice(random_cars.STEPS))

    def simulate(method: str, h: float) -> mbs.Trajectory:
        return mbs.simulate(
            system, span, h, inputs, mbs.Settings(method=method), road, every=round(step / h),
            pose=mbs.Pose(**pose), estimate_error=False, progress=False,
        )  # fmt: skip

    reference = random_cars.reference_by_two_methods(system, simulate)
    start = {f"initial.{name}": value for name, value in pose.items()} | road | inputs
    run = partial(_through_fmpy, lambda: fmu_of_car(car, lambda _: None), list(reference), span, start)
    return Case(f"{car}, {'falls' if falls else 'kerb'}", system, reference, span, run, (step,), ())


def fmu_mechanisms(rng: np.random.Generator) -> Case:
    """FMUs of random mechanisms through FMPy, for up to 10 s."""
    kind, mechanism = random_mechanisms.random_mechanism(rng)
    span = float(round(rng.uniform(2.0, 10.0), 1))
    drive = None if mechanism.drive is None else PPoly(mechanism.drive.c, [0.0, 2.0 * span])
    case = _mechanism_case(kind, replace(mechanism, drive=drive, span=span))

    @cache
    def built() -> Path:
        folder = Path(tempfile.mkdtemp())
        atexit.register(shutil.rmtree, folder)
        return build_fmu(case.system, "mechanism", folder, [platform])

    return replace(case, run=partial(_through_fmpy, built, list(case.reference), span, {}), tolerances=())


def _through_fmpy(
    built: Callable[[], Path], names: list[str], span: float, start: dict[str, float], h: float, every: int
) -> CaseRun:
    """Simulate an FMU with steps of its `step_size`; each message of the FMU is issued as a warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the run that is part of building an FMU
        path = built()
    with Fmu(path) as fmu:
        get = fmu.getter(names)
        fmu.initialise(start | {"step_size": h})
        rows = [get()]
        for k in range(round(span / h)):
            try:
                fmu.step(k * h, h)
            except StepRefusedError as error:
                raise mbs.SimulationError(str(error), k * h, Status.NOT_CONVERGED) from error
            rows += [get()] if (k + 1) % every == 0 else []
        texts = fmu.messages
    for text in texts:
        warnings.warn(text, mbs.AccuracyWarning, stacklevel=1)
    return CaseRun(dict(zip(names, np.array(rows).T, strict=True)), None)


FAMILIES: dict[str, Callable[[np.random.Generator], Case]] = {
    "planar": planar,
    "spatial": spatial,
    "cars": cars,
    "machines": machines,
    "boxes": boxes_case,
    "jumps": jumps,
    "switches": switches,
    "flexible": flexible,
    "gears": gears,
    "tumbling": tumbling,
    "chaotic": chaotic,
    "fmus": fmus,
    "fmu_mechanisms": fmu_mechanisms,
}
