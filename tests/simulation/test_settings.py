"""Settings are checked when they are created, and their defaults are the kernel's."""

import pytest

from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.settings.settings import Settings
from tests.simulation.scenes import pendulum


@pytest.mark.parametrize(
    ("field", "value", "sentence"),
    [
        ("alpha", -1.0, "'alpha' is -1.0; it must be positive, or 0"),
        ("alpha", float("nan"), "'alpha' is nan; it must be a finite number"),
        ("eps_rel", 0.0, "'eps_rel' is 0.0; it must be positive"),
        ("tolerance_phi", -1e-9, "'tolerance_phi' is -1e-09; it must be positive"),
        ("max_iterations", 0, "'max_iterations' is 0; it must be a whole number from 1 to 1000"),
        ("max_iterations", 2.5, "'max_iterations' is 2.5; it must be a whole number from 1 to 1000"),
        ("max_halvings", -1, "'max_halvings' is -1; it must be a whole number from 0 to 16"),
        ("step_iterations", -1, "'step_iterations' is -1; it must be a whole number from 0 to 1000"),
        ("geometric", 2, "'geometric' is 2; it must be True or False"),
        ("method", ["ali3p"], "'method' is ..ali3p..; it must be one of 'ali3p', .*'radau_5'"),
        ("predictor", "x", "'predictor' is 'x'; it must be one of 'parabola', 'acceleration'"),
        ("update", "newton", "'update' is 'newton'; it must be one of 'linearised', 'paper'"),
    ],
)
def test_a_wrong_value_is_refused_by_name(field, value, sentence):
    with pytest.raises(ValueError, match=sentence):
        Settings(**{field: value})


def test_the_defaults_are_those_of_the_kernel():
    assert Instance(LoadedSystem(pendulum().to_bytes())).settings() == Settings().kernel_fields() | {"part_ratio": 1.0}


def test_every_field_reaches_the_kernel():
    instance = Instance(LoadedSystem(pendulum().to_bytes()))
    other = Settings(
        1e9,
        1e-6,
        1e-9,
        1e-8,
        7,
        3,
        project=False,
        update="paper",
        geometric=False,
        method="ali3p_generalised_alpha",
        predictor="acceleration",
        step_iterations=4,
        rho_infinity=0.5,
    )
    changed = other.kernel_fields()
    assert all(changed[name] != value for name, value in Settings().kernel_fields().items())
    instance.set_settings(**changed)
    assert instance.settings() == changed | {"part_ratio": 1.0}, "that of a run that checks another one is no setting"
