"""The modelling vocabulary."""

from mbs.errors import ModelError
from mbs.model.body import Body, PointMass
from mbs.model.core import Coordinate
from mbs.model.guides import Guide
from mbs.model.inputs import Input
from mbs.model.joints.joint import Joint
from mbs.model.model import Model
from mbs.model.parameters import Parameter
from mbs.model.sensors import Sensor
from mbs.model.slide import SlidingPoint
from mbs.model.spin import Spin

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
