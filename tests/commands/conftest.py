"""An FMU of a small scene for the commands."""

from pathlib import Path

import pytest

import mbs
from fmu_src.build.build import build_fmu
from fmu_src.native.platforms import this_platform


def swing(**texts: str) -> mbs.Model:
    """A rod on a hinge with a motor."""
    m = mbs.Model("swing", dimension=2)
    rod = m.body("rod", mass=2.0, com=(0.0, -0.5), inertia=0.17)
    m.revolute("hinge", m.ground, rod, point=(0.0, 0.0))
    angle = m.relative_angle("angle", m.ground, rod)
    torque = m.input("torque", min=-20.0, max=20.0, unit="N.m", **texts)
    m.torque_on("motor", angle, input=torque)
    m.sense_coordinate("rod.angle", angle, description="Angle of the rod, zero when it hangs")
    return m


@pytest.fixture(scope="session")
def swing_fmu(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The FMU of that rod for this machine."""
    return build_fmu(mbs.compile(swing()), "swing", tmp_path_factory.mktemp("swing"), [this_platform()])
