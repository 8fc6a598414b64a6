"""One step of the states of elements alone, at held coordinates."""

import pytest

from mbs import Model, compile
from mbs.elements import CoordinateFriction
from mbs.kernel.binding.instance import Instance
from mbs.kernel.binding.loaded_system import LoadedSystem


def test_element_states_step_from_those_that_are_given() -> None:
    """A friction that sticks: its force is its stiffness times what the joint has turned since it stuck, the state."""
    m = Model("hinge", dimension=2, gravity=(0.0, 0.0))
    arm = m.body("arm", mass=1.0, com=(0.5, 0.0), inertia=0.1)
    m.revolute("pin", m.ground, arm, point=(0.0, 0.0))
    angle = m.relative_angle("angle", m.ground, arm)
    m.add(CoordinateFriction(10.0, 1000.0, 1.0).record("friction", angle.affine))
    system = compile(m)
    instance = Instance(LoadedSystem(system.to_bytes()))
    q, qd = system.arrays["q0"].tolist(), system.arrays["qd0"].tolist()
    own, force = instance.element_step(q, qd, None, 1e-3)
    forces = {}
    for stuck in (0.0, 2e-3, -4e-3):
        states = [stuck, *own[1:]]
        after, actual = instance.element_step(q, qd, states, 1e-3)
        forces[stuck] = max(actual, key=abs)
        if stuck == 0.0:
            assert (list(after), list(actual)) == (list(own), list(force))
    assert forces[0.0] == pytest.approx(0.0, abs=1e-9)
    assert abs(forces[2e-3]) == pytest.approx(1000.0 * 2e-3, rel=1e-6)
    assert forces[-4e-3] == pytest.approx(-2.0 * forces[2e-3], rel=1e-6)
