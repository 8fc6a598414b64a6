"""The modelling vocabulary."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mbs.common.lazy_modules import lazy_modules

if TYPE_CHECKING:
    from mbs.common.errors import ModelError
    from mbs.model.body import Body
    from mbs.model.carried import SlidingPoint, Spin
    from mbs.model.coordinate import Coordinate
    from mbs.model.joints.joint import Joint
    from mbs.model.model import Model
    from mbs.model.point_mass import PointMass
    from mbs.model.records import Guide, Input, Parameter
    from mbs.model.sensor import Sensor

# imported when they are first asked for: who compiles a mechanism needs no word of it
_LAZY = {
    "Body": "mbs.model.body",
    "Coordinate": "mbs.model.coordinate",
    "Guide": "mbs.model.records",
    "Input": "mbs.model.records",
    "Joint": "mbs.model.joints.joint",
    "Model": "mbs.model.model",
    "ModelError": "mbs.common.errors",
    "Parameter": "mbs.model.records",
    "PointMass": "mbs.model.point_mass",
    "Sensor": "mbs.model.sensor",
    "SlidingPoint": "mbs.model.carried",
    "Spin": "mbs.model.carried",
}
__getattr__ = lazy_modules(__name__, (), _LAZY)

__all__ = [
    "Body",
    "Coordinate",
    "Guide",
    "Input",
    "Joint",
    "Model",
    "ModelError",
    "Parameter",
    "PointMass",
    "Sensor",
    "SlidingPoint",
    "Spin",
]


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
