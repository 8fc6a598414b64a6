"""Parameters: scale and offset, fixed and tunable, one writer for each number."""

import pytest

from mbs import Model, ModelError, Simulation, System, compile, simulate
from mbs.elements import EndStops, PlaneRoad
from mbs.kernel.binding import KernelError, LoadedSystem, Status
from mbs.kernel.binding.instance import Instance


def balance(front=0.6, offset=True):
    """Two springs share a weight: `share` of 100 N/m is in the first one, the rest in the second."""
    m = Model("balance", dimension=2)
    bob = m.point_mass("bob", mass=2.0, position=(0.0, -1.0))
    one = m.spring_damper("one", (m.ground, (0.0, 0.0)), bob, stiffness=100.0 * front, damping=1.0, free_length=1.0)
    two = m.spring_damper(
        "two", (m.ground, (0.0, -3.0)), bob, stiffness=100.0 * (1.0 - front), damping=1.0, free_length=1.0
    )
    if offset:
        targets = [(one, "stiffness", 100.0), (two, "stiffness", -100.0, 100.0)]
        m.parameter("share", front, 0.1, 0.9, targets=targets)
        m.parameter("damping", 1.0, 0.0, 5.0, "N.s/m", targets=[(two, "damping", 1.0)], tunable=False)
    m.sense_position("y", bob, None, "y")
    return m


def test_an_offset_lets_one_number_share_out():
    """The same run as of a model that is drawn so."""
    system = compile(balance())
    for share in (0.6, 0.3):
        expected = simulate(compile(balance(share, offset=False)), t_end=1.0, h=0.01)["y"]
        simulation = Simulation(system, parameters={"share": share}).run(1.0, 0.01)["y"]
        assert list(simulation) == pytest.approx(list(expected), rel=0, abs=1e-12)
    other = Simulation(system, parameters={"share": 0.3}).run(1.0, 0.01)["y"]
    assert abs(other[-1] - Simulation(system).run(1.0, 0.01)["y"][-1]) > 0.01


def test_parameters_are_tunable_where_a_file_does_not_say_which_are_fixed():
    system = compile(balance())
    arrays = {name: values for name, values in system.arrays.items() if name != "par_fixed"}
    simulation = Simulation(System(arrays, system.meta))
    simulation.set_parameter("damping", 2.0)
    simulation.step(0.01)


def test_a_fixed_parameter_is_set_before_the_start_only():
    system = compile(balance())
    simulation = Simulation(system, parameters={"damping": 3.0})
    for _ in range(2):  # at the start, and after a step
        before = simulation.save()
        with pytest.raises(ValueError, match=r"'damping' is fixed and cannot be set at t = .*parameters=\{'damp"):
            simulation.set_parameter("damping", 2.0)
        assert simulation.save() == before
        simulation.step(0.01)
    instance = Instance(LoadedSystem(system.to_bytes()))
    instance.initialise()
    with pytest.raises(KernelError) as refused:
        instance.set_parameter(1, 2.0)
    assert refused.value.status == Status.FIXED_PARAMETER
    instance.reset()
    instance.set_parameter(1, 2.0)
    assert instance.get_parameter(1) == 2.0


def test_a_tunable_parameter_holds_from_the_next_step_on():
    simulation, other = Simulation(compile(balance())), Simulation(compile(balance()))
    simulation.step(0.01)
    other.step(0.01)
    other.set_parameter("share", 0.3)
    assert simulation.sensors == other.sensors
    simulation.step(0.01)
    other.step(0.01)
    assert simulation.sensors != other.sensors


def test_what_a_parameter_writes_at_its_limits_is_checked_with_the_offset():
    m = balance(offset=False)
    with pytest.raises(ModelError, match=r"At the max 0.9 of parameter 'share', the stiffness of element 'two' is -10"):
        m.parameter("share", 0.5, 0.1, 0.9, targets=[("two", "stiffness", -100.0, 80.0)])


def test_a_number_takes_its_value_from_one_parameter():
    m = balance()
    road = m.road(PlaneRoad(friction=0.5))
    m.parameter("friction", 0.5, 0.0, 1.0, targets=[(("road", road), "friction", 1.0)])
    with pytest.raises(ModelError, match="the stiffness of element 'two', which parameter 'share' writes already"):
        m.parameter("again", 1.0, 1.0, 2.0, targets=[("two", "stiffness", 1.0)])
    with pytest.raises(ModelError, match="the friction of road 0, which parameter 'friction' writes already"):
        m.parameter("again", 1.0, 1.0, 2.0, targets=[(("road", road), "friction", 1.0)])
    with pytest.raises(ModelError, match="which another of its targets writes already"):
        m.parameter("again", 1.0, 1.0, 2.0, targets=[("one", "damping", 1.0), ("one", "damping", 2.0)])


@pytest.mark.parametrize("real", ["mass", ["ratio"], 0])
def test_what_a_thing_does_not_have_is_refused_in_a_sentence(real):
    m = Model("geared", dimension=2)
    rod = m.body("rod", mass=1.0, com=(0.5, 0.0), inertia=0.1)
    m.armature("motor", m.relative_angle("angle", m.ground, rod), inertia=0.1)
    with pytest.raises(ModelError, match="writes .* of 'motor', but the model has no such element"):
        m.parameter("k", 1.0, 0.5, 2.0, targets=[("motor", real, 1.0)], tunable=False)


def test_values_that_only_together_are_wrong_are_refused():
    """Metal that meets metal at once, without a depth over which it sets in, cannot be."""
    m = Model("stops", dimension=2)
    bob = m.point_mass("bob", mass=2.0, position=(0.0, -1.0))
    stops = EndStops(bump_length=0.8, bump_stiffness=1e3, metal_stiffness=1e5)
    spring = m.spring_damper("spring", (m.ground, (0.0, 0.0)), bob, stiffness=10.0, free_length=1.0, stops=stops)
    m.parameter("metal", 1e5, 0.0, 1e6, "N/m", targets=[(spring, "metal_stiffness", 1.0)])
    m.parameter("onset", 0.001, 0.0, 0.1, "m", targets=[(spring, "metal_onset", 1.0)])
    simulation = Simulation(compile(m))
    with pytest.raises(ValueError, match=r"'onset' is set to 0.0 m, which the model cannot take beside its other"):
        simulation.set_parameter("onset", 0.0)
    assert simulation.instance.get_parameter(1) == 0.001
    simulation.set_parameter("metal", 0.0)
    simulation.set_parameter("onset", 0.0)
    with pytest.raises(ValueError, match=r"'metal' is set to 1 N/m, which the model cannot take beside its other"):
        simulation.set_parameter("metal", 1)
