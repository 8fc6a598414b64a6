"""The modelling vocabulary."""

from mbs.common.errors import ModelError
from mbs.model.body import Body, PointMass
from mbs.model.carried import SlidingPoint, Spin
from mbs.model.coordinate import Coordinate
from mbs.model.joints.joint import Joint
from mbs.model.model import Model
from mbs.model.records import Guide, Input, Parameter
from mbs.model.sensor import Sensor

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
