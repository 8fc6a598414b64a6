"""The modelling vocabulary."""

from typing import TYPE_CHECKING

from mbs.common.lazy_modules import lazy_modules

if TYPE_CHECKING:
    from mbs.common.errors import ModelError as ModelError
    from mbs.model.body import Body as Body
    from mbs.model.carried_parts import SlidingPoint as SlidingPoint
    from mbs.model.carried_parts import Spin as Spin
    from mbs.model.coordinate import Coordinate as Coordinate
    from mbs.model.joints.joint import Joint as Joint
    from mbs.model.model import Model as Model
    from mbs.model.point_mass import PointMass as PointMass
    from mbs.model.records import DrivingFunction as DrivingFunction
    from mbs.model.records import Input as Input
    from mbs.model.records import Parameter as Parameter
    from mbs.model.sensor import Sensor as Sensor

# imported on first use, because a run of a System needs none of them
_LAZY = {
    "Body": "mbs.model.body",
    "Coordinate": "mbs.model.coordinate",
    "DrivingFunction": "mbs.model.records",
    "Input": "mbs.model.records",
    "Joint": "mbs.model.joints.joint",
    "Model": "mbs.model.model",
    "ModelError": "mbs.common.errors",
    "Parameter": "mbs.model.records",
    "PointMass": "mbs.model.point_mass",
    "Sensor": "mbs.model.sensor",
    "SlidingPoint": "mbs.model.carried_parts",
    "Spin": "mbs.model.carried_parts",
}
__getattr__ = lazy_modules(__name__, (), _LAZY)

__all__ = [*_LAZY]


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
