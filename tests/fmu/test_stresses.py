"""Stresses of the rigid car: found when they are read, from the motion and without a trace in it."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave

from hosts.fmu.fmu import Fmu
from mbs import Simulation, System, compile, simulate
from mbs.compiler.ports import map_followers, with_ports_of
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.scenes import kerb_test, pendulum, prototype_car
from tests import kinds

H = 0.01  # s
EDGE = 760  # steps; the front wheels are over the kerb ten steps later
LEFT_OUT = ("stress", "bending_moment")
GAUGES = tuple(f"{what}.SG{k}" for what in ("bending_moment", "stress") for k in (1, 2, 3, 4))


class Bare:
    """An instance of either version through FMPy, its real outputs by name."""

    def __init__(self, file: Path) -> None:
        description = fmpy.read_model_description(str(file))
        arguments = {
            "guid": description.guid,
            "unzipDirectory": fmpy.extract(str(file)),
            "modelIdentifier": description.coSimulation.modelIdentifier,
            "instanceName": "bare",
        }
        self.references = {v.name: v.valueReference for v in description.modelVariables}
        real = [v for v in description.modelVariables if v.causality == "output" and v.type in ("Real", "Float64")]
        self.other = [(v.valueReference, v.shape or (1,)) for v in real if v.name.partition(".")[0] not in LEFT_OUT]
        self.third = description.fmiVersion == "3.0"
        self.slave: Any = FMU3Slave(**arguments) if self.third else FMU2Slave(**arguments)
        self.slave.instantiate()
        if self.third:
            self.slave.setInt32([self.references["fidelity"]], [0])
        else:
            self.slave.setInteger([self.references["fidelity"]], [0])
            self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def motion(self) -> list[float]:
        """All outputs but those of the frame."""
        if self.third:
            return [x for r, shape in self.other for x in self.slave.getFloat64([r], int(np.prod(shape)))]
        return list(self.slave.getReal([r for r, _ in self.other]))

    def stress(self) -> float:
        get = self.slave.getFloat64 if self.third else self.slave.getReal
        return float(get([self.references["stress.SG3"]])[0]) if "stress.SG3" in self.references else np.nan

    def run(self, first: int, last: int) -> None:
        for k in range(first, last):
            self.slave.doStep(k * H, H)

    def saved(self) -> Any:
        return self.slave.getFMUState()


@pytest.mark.parametrize("kind", kinds.VERSIONS)
def test_reading_stresses_leaves_no_trace(kerb_fmus: Path, kind: str) -> None:
    unread, read = Bare(kerb_fmus / f"{kind}.fmu"), Bare(kerb_fmus / f"{kind}.fmu")
    unread.run(0, EDGE)
    assert np.isfinite(read.stress())
    read.run(0, EDGE)
    peak = 0.0
    for k in range(EDGE, EDGE + 60):
        peak = max(peak, abs(read.stress()))
        if k == EDGE + 20:  # a state that was saved after reading goes on as one that was not
            state = read.saved()
            read.run(k, k + 3)
            read.stress()
            read.slave.setFMUState(state)
        unread.run(k, k + 1)
        read.run(k, k + 1)
        assert read.motion() == unread.motion()
    assert peak > 3e6
    after = read.stress()
    state = unread.saved()
    unread.run(EDGE + 60, EDGE + 70)
    unread.slave.setFMUState(state)
    assert unread.stress() == after


def test_reading_another_output_asks_nothing_of_the_frame(kerb_fmus: Path) -> None:
    """The System with ports is read with the first stress: without its file all but the stresses are there."""
    with Fmu(kerb_fmus / "native.fmu") as fmu:
        fmu.load()
        next(fmu._folder.glob("resources/**/system_1.ali3")).unlink()
        fmu.initialise({"fidelity": 0.0})
        fmu.step(0.0, H)
        assert np.isfinite(fmu.getter(("speed", "chassis.x"))()).all()
        with pytest.raises(FMICallException):
            fmu.getter(("stress.SG1",))()
        assert any("system_1.ali3" in line and "cannot be read" in line for line in fmu.messages)
        fmu.step(H, H)


def test_stresses_have_no_rates(kerb_fmus: Path) -> None:
    with Fmu(kerb_fmus / "native.fmu") as fmu:
        fmu.initialise({"fidelity": 0.0})
        fmu.step(0.0, H)
        reference = [scalar.reference for scalar in fmu.scalars(["stress.SG1"])]
        with pytest.raises(FMICallException):
            fmu._slave.getRealOutputDerivatives(reference, [1])
        assert any("'stress.SG1' is not known: it depends on forces" in line for line in fmu.messages)


Pair = tuple[System, System, System]
"""A rigid car, the one with ports, and that which follows the rigid one."""


def pair(make: Callable[[int], Any]) -> Pair:
    without, ported = compile(make(0)), compile(make(1))
    follower = with_ports_of(ported, without)
    assert follower is not None
    return without, ported, follower


@pytest.fixture(scope="module")
def at_the_kerb() -> Pair:
    return pair(kerb_test.build)


@pytest.fixture(scope="module")
def prototypes() -> Pair:
    return pair(lambda fidelity: prototype_car.build(fidelity=fidelity))


def loaded(system: System) -> Instance:
    return Instance(LoadedSystem(system.kernel_bytes(modes=False)))


def gauges_of(system: System, instance: Instance) -> np.ndarray:
    names = [s["name"] for s in system.meta["sensors"]]
    return np.array(instance.sensors())[[names.index(g) for g in GAUGES]]


@pytest.mark.parametrize(("h", "bound"), [(0.01, 2.5e-4), (0.002, 1e-5)])
def test_down_a_kerb_they_are_those_of_the_run_with_ports(at_the_kerb: Pair, h: float, bound: float) -> None:
    """Largest difference as a share of the peak; the forces are those of each step's own rule."""
    without, ported, follower = at_the_kerb
    rigid, own, following_it = loaded(without), loaded(ported), loaded(follower)
    rows = []
    for instance in (rigid, own):
        instance.initialise()
        instance.run(h, round(7.6 / h))
    for _ in range(round(0.7 / h)):
        rigid.step(h)
        own.step(h)
        following_it.follow(rigid)
        rows.append((gauges_of(without, following_it), gauges_of(ported, own)))
    values, expected = np.array(rows).transpose(1, 0, 2)
    assert (np.abs(values - expected).max(axis=0) / np.abs(expected).max(axis=0)).max() < bound


def test_payloads_inputs_and_road_follow(prototypes: Pair) -> None:
    without, ported, follower = prototypes
    rigid, own, following_it = loaded(without), loaded(ported), loaded(follower)
    parameters = {p["name"]: k for k, p in enumerate(without.meta["parameters"])}
    inputs = {u["name"]: k for k, u in enumerate(without.meta["inputs"])}
    for instance in (rigid, own):
        for name, value in (("payload.passenger.mass", 90.0), ("front.spring.stiffness", 25000.0)):
            instance.set_parameter(parameters[name], value)
        instance.set_pose(0.0, 0.0, 0.05, 0.3, 12.0)
        instance.set_input(inputs["steering"], 0.2)
        instance.set_input(inputs["brake"], 0.3)
        instance.initialise()
        instance.run(0.002, 300)
    following_it.follow(rigid)
    gap, expected = gauges_of(without, following_it) - gauges_of(ported, own), gauges_of(ported, own)
    for kind in (slice(0, 4), slice(4, 8)):  # moments, stresses
        assert np.abs(gap[kind]).max() < 1e-3 * np.abs(expected[kind]).max()
    rigid.set_parameter(parameters["road.friction"], 0.4)
    following_it.follow(rigid)
    assert following_it.get_parameter(parameters["road.friction"]) == 0.4

    # a model that cannot take the mass stays as it is
    mass, scale = parameters["payload.passenger.mass"], np.array(follower.arrays["par_scale"])
    scale[follower.arrays["par_ptr"][mass] : follower.arrays["par_ptr"][mass + 1]] *= -1.0
    refusing = loaded(follower.with_arrays({"par_scale": scale}))
    before = [refusing.get_parameter(k) for k in parameters.values()]
    with pytest.raises(KernelError, match="argument"):
        refusing.follow(rigid)
    assert [refusing.get_parameter(k) for k in parameters.values()] == before


def test_only_the_same_model_is_followed(prototypes: Pair) -> None:
    without, ported, follower = prototypes
    other = compile(pendulum.build())
    assert without.ported is not None  # who steps a rigid car gets its stresses
    assert without.ported(without) is not None
    assert with_ports_of(ported, other) is None
    assert with_ports_of(without, ported) is None
    assert with_ports_of(System.from_bytes(ported.to_bytes()), without) is None  # a file has no full coordinates
    assert map_followers([without, ported])[1] == [1, -1]
    assert map_followers([without])[1] == [-1]
    rigid, alone = loaded(without), loaded(other)
    with pytest.raises(KernelError, match="must be initialised first"):
        loaded(follower).follow(rigid)
    alone.initialise()
    rigid.initialise()
    for one, two in ((loaded(follower), alone), (loaded(ported), rigid)):
        with pytest.raises(KernelError, match="argument"):
            one.follow(two)


@pytest.mark.slow
def test_a_run_in_python_has_the_same_numbers(kerb_fmus: Path) -> None:
    """Bit for bit those of the FMU, from one run and from states; a thinned run has those of its samples."""
    system = compile(kerb_test.build(0))
    run = simulate(system, 7.9, H, every=10, progress=False, estimate_error=False)
    with Fmu(kerb_fmus / "native.fmu") as fmu:
        fmu.initialise({"fidelity": 0.0})
        read = fmu.getter(GAUGES)
        rows = [read()]
        for k in range(790):
            fmu.step(k * H, H)
            if k % 10 == 9:
                rows.append(read())
    assert np.array_equal(np.array(rows), np.column_stack([run[name] for name in GAUGES]))
    assert np.abs(run["stress.SG3"]).max() > 3e6
    assert run["stress.computed"].tolist() == [1.0] * len(run.t)
    again = simulate(system, 1.2, H, every=10, progress=False, estimate_error=False)
    assert np.array_equal(again.thinned(3).thinned(2)["stress.SG2"], run["stress.SG2"][:13:6])
    stepped = Simulation(system)
    stepped.step(H, 780)
    seen = stepped.sensors
    stepped.step(H, 10)
    assert seen["stress.SG3"] == run["stress.SG3"][78]
    assert stepped.sensors["stress.SG3"] == run["stress.SG3"][79]
    assert stepped.sensors["chassis.x"] == run["chassis.x"][79]


def test_unread_in_python_they_cost_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """No second System is made and no force at a port is sought; reading changes no number of the run."""
    calls: list[str] = []
    follow, model = Instance.follow, prototype_car.build()
    make = model.with_ports
    assert make is not None
    monkeypatch.setattr(Instance, "follow", lambda self, other: (calls.append("follow"), follow(self, other)))
    model.with_ports = lambda: (calls.append("model"), make())[1]
    system = compile(model)
    run = simulate(system, 0.1, H, progress=False)
    assert Simulation(system).sensors["speed"] == run["speed"][0]
    assert calls == []
    assert run["stress.SG1"].shape == run.t.shape
    assert calls == ["model"] + ["follow"] * len(run.t)


@pytest.mark.slow
def test_a_system_that_nothing_follows_has_no_stresses(tmp_path: Path) -> None:
    """From a file, with more than the car has, to a tolerance: a sentence, never 0."""
    system = compile(prototype_car.build())
    system.save(tmp_path / "car.ali3")
    grown = prototype_car.build()
    grown.input("of the user")
    for loaded in (System.load(tmp_path / "car.ali3"), compile(grown), system.with_arrays({})):
        run = simulate(loaded, 0.02, H, progress=False)
        assert "stress.SG1" not in run
        with pytest.raises(KeyError, match=r"'stress.SG1' is not computed by this System: .* fidelity=1"):
            run["stress.SG1"]
        with pytest.raises(KeyError, match=r"'stress.SG1' is not computed"):
            Simulation(loaded).sensors["stress.SG1"]
    run = simulate(system, 0.02, tolerance=1e-2, progress=False)
    with pytest.raises(KeyError, match=r"'stress.SG1' is not computed .* to a tolerance .* steps of a length h"):
        run["stress.SG1"]
