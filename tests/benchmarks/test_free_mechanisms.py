"""Each joint and each force in a free mechanism: none is left out, and energy stays where a method keeps it."""

import inspect
import warnings

import numpy as np
import pytest

import mbs
from benchmarks import work_precision
from benchmarks.methods.free_elements import ELEMENTS
from benchmarks.methods.free_runs import MAX_CHANGE, MECHANISMS, STEPS, TURNS, measure
from benchmarks.methods.free_wheels import FreeModel
from mbs.elements import ElementType
from tests.quick import quick

KINDS = {"Joint", "Screw", "ElementRecord", "Armature", "Spin", "SlidingPoint", "Coordinate"}
OF_CARS = {"TYRE", "MAGIC_TYRE", "HUB_WRENCH", "AUTOMATIC_DRIVE", "ELECTRIC_DRIVE", "SPIN_ANGLE"}
"""Elements that only a car has: its balance of energy and work is tested as a whole; the last has no force."""


def test_each_joint_and_each_force_has_a_mechanism(monkeypatch):
    message = {
        name
        for name, method in inspect.getmembers(mbs.Model, inspect.isfunction)
        if getattr(kind := method.__annotations__.get("return"), "__name__", kind) in KINDS and not name.startswith("_")
    }
    used, types = set(), set()

    def noted(name, method):
        return lambda *given, **more: used.add(name) or method(*given, **more)

    for name in message:
        monkeypatch.setattr(mbs.Model, name, noted(name, getattr(mbs.Model, name)))
    for build in MECHANISMS.values():
        types |= {element.type.name for element in build(1.0).model.elements}
    assert message - used == {"joint_named"}
    assert {kind.name for kind in ElementType} - types == OF_CARS


@pytest.mark.slow
def test_energy_momentum_keeps_the_energy_of_each():
    for name in ELEMENTS:
        actual = measure(name, 0.2, 150, "energy_momentum")
        if name == "lookup-table body":
            assert actual["told"] == "no"
        else:
            assert actual["energy"] < (0.1 if name.startswith("drive") else 1e-4 if name == "friction" else 1e-8), (
                actual
            )


def test_a_force_that_gives_energy_is_seen():
    """A spring without its energy: what the bodies have is not kept."""
    result = measure("spring, stops", 0.5, 500, "radau_5", with_check=True)
    assert result["energy"] > MAX_CHANGE
    assert result["grows"]
    assert "AccuracyWarning" in result["told"]


def test_the_command_gives_the_tables(capsys):
    assert work_precision.main(["free", "--quick", "--only", "weld", "rack", "--methods", "ali3p"]) == 0
    assert "| rack |" in capsys.readouterr().out


@pytest.mark.proof  # twelve minutes
def test_what_grows_is_reported_over_a_hundred_thousand_steps():
    """Bounded errors beyond `WRONG` are those of the page."""
    for name in MECHANISMS:
        for turn in TURNS:
            result = measure(name, turn, STEPS, with_check=True)
            assert result["energy"] is None or result["energy"] < MAX_CHANGE or result["told"] or not result["grows"], (
                result
            )


JOINTS = {
    "revolute": lambda m, *two, p, u: m.revolute(*two, point=p, axis=u),
    "spherical": lambda m, *two, p, u: m.spherical(*two, point=p),
    "universal": lambda m, *two, p, u: m.universal(*two, point=p, axis_1=u, axis_2=np.cross(u, (0.3, 0.5, -0.8))),
    "cylindrical": lambda m, *two, p, u: m.cylindrical(*two, point=p, axis=u),
    "prismatic": lambda m, *two, p, u: m.prismatic(*two, axis=u),
    "screw": lambda m, *two, p, u: m.screw(*two, point=p, axis=u, pitch=0.3),
    "weld": lambda m, *two, p, u: m.weld(*two),
    "point on line": lambda m, name, a, b, p, u: m.point_on_line(name, (b, p), (a, p), axis=u),
    "distance": lambda m, name, a, b, p, u: m.distance(name, (a, p), (b, p + u)),
}


def pair(rng):
    """Two bodies in a row on two joints drawn by chance, with a force of each kind; the names of the joints too."""
    free = FreeModel(3, weight=rng.choice([0.0, 2.0]))
    m, chosen = free.model, [str(k) for k in rng.choice(list(JOINTS), 2, replace=False)]
    bodies = [m.ground]
    for k, joint in enumerate(chosen):
        inertia = 0.1 + rng.uniform(0.0, 0.05, 3)
        body = m.body(f"body {k}", mass=rng.uniform(0.5, 2.0), com=rng.uniform(-1.0, 1.0, 3), inertia=inertia)
        u = rng.normal(size=3)
        JOINTS[joint](m, f"joint {k}", bodies[-1], body, p=rng.uniform(-1.0, 1.0, 3), u=u / np.linalg.norm(u))
        bodies.append(body)
    last, hook = bodies[-1], rng.uniform(1.0, 2.0, 3)
    m.spring_damper("spring", (m.ground, -hook), (last, hook), stiffness=5.0, damping=rng.choice([0.0, 0.3]))
    m.spring_damper("hold", (m.ground, hook), (bodies[1], -hook), stiffness=5.0)
    m.force("push", last, hook, inputs=[free.pedal("push", 1.0, 2.0), None, None], axes="body")
    m.torque("turn", last, inputs=[None, free.pedal("turn", 0.5, 3.0), None])
    m.drag("drag", last, hook, drag_area=0.05)
    m.initial_velocity(last, rng.normal(size=3), rng.normal(size=3))
    return free, chosen


def ran(free, system, method, h=0.005, check=False):
    """A run, and the change of the energy that is no work, in parts of the energy."""
    check = None if check else False
    r = mbs.simulate(system, 3.0, h, free.inputs, method=method, progress=False, estimate_error=check)
    assert np.ptp(r["work"]) > 1e-4 * np.abs(r["energy"]).max()
    return r, np.abs(r["energy"] - r["energy"][0] - r["work"]).max() / np.abs(r["energy"]).max()


def check_pairs(count, seed):
    """Energy is work to round-off by energy-momentum, by Runge and Kutta's rule as the step falls; what the default
    loses where rods whirl leaves its places right or is told."""
    rng = np.random.default_rng(seed)
    places = ("x of body 0", "x of body 1", "x beside body 0", "x beside body 1")
    for number in range(count):
        free, chosen = pair(rng)
        system, which = free.compiled(), (seed, number, chosen)
        assert ran(free, system, "energy_momentum")[1] < 1e-8, which
        right, open_by = ran(free, system, "runge_kutta_8")
        assert open_by < 1e-3 or ran(free, system, "runge_kutta_8", 0.00125)[1] < 0.2 * open_by, which
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            r, open_by = ran(free, system, "ali3p", check=True)
        if open_by > 1e-3 and not any(issubclass(w.category, mbs.AccuracyWarning) for w in caught):
            off = max(np.abs(r[name] - right[name]).max() for name in places)
            assert off < 0.05 * max(np.ptp(right[name]) for name in places), (*which, off)


def test_energy_of_two_joints_drawn_by_chance_is_work():
    check_pairs(4, 1)


@pytest.mark.slow
@pytest.mark.parametrize(("count", "seed"), quick([(50, 3639317403)], [(50, 3639317403), (200, None)], "proof"))
def test_energy_of_many_pairs_of_joints_is_work(count, seed):
    """None: by chance, printed. Of 2071716515 pair 2 is too fast for the step, of which the check of the run warns."""
    seed = int(np.random.SeedSequence().entropy) % 2**32 if seed is None else seed
    print(f"seed {seed}")
    check_pairs(count, seed)
