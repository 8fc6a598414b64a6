"""Joints by name: each method of a model is made from the function that makes the joint."""

import functools
from collections.abc import Callable
from typing import Concatenate, ParamSpec, TypeVar

from mbs.model.angle import relative_angle
from mbs.model.anti_roll_bar import anti_roll_bar
from mbs.model.bodies import BodyVocabulary
from mbs.model.joints.coupled_slides import coupled_slides
from mbs.model.joints.distance import distance
from mbs.model.joints.drive import drive
from mbs.model.joints.drop_link import drop_link
from mbs.model.joints.gear import gear
from mbs.model.joints.joint import Joint
from mbs.model.joints.pin import pin
from mbs.model.joints.points import spherical
from mbs.model.joints.prismatic import prismatic
from mbs.model.joints.rack import rack
from mbs.model.joints.revolute import revolute
from mbs.model.joints.rolling import rolling, skate
from mbs.model.joints.screw import screw
from mbs.model.joints.sliding import cylindrical, point_on_line
from mbs.model.joints.universal import universal
from mbs.model.joints.weld import weld

P = ParamSpec("P")
M = TypeVar("M", bound=BodyVocabulary)


def joins(make: Callable[Concatenate[M, P], Joint]) -> Callable[Concatenate[M, P], Joint]:
    """The function `make`, with its signature and its docstring, as a method that adds the joint to the model."""

    @functools.wraps(make)
    def method(model: M, /, *args: P.args, **kwargs: P.kwargs) -> Joint:
        return model._join(make(model, *args, **kwargs))

    return method


class JointVocabulary(BodyVocabulary):
    """Joints; each method returns the joint, for sensors.

    Points and axes are given in earth axes in the reference configuration. If the drawing does not close, `point`
    (or `axis`) may be a pair, one per body.
    """

    spherical = joins(spherical)
    revolute = joins(revolute)
    universal = joins(universal)
    cylindrical = joins(cylindrical)
    prismatic = joins(prismatic)
    point_on_line = joins(point_on_line)
    weld = joins(weld)
    distance = joins(distance)
    drop_link = drop_link
    drive = joins(drive)
    pin = joins(pin)
    rolling = joins(rolling)
    skate = joins(skate)
    gear = joins(gear)
    rack = joins(rack)
    coupled_slides = joins(coupled_slides)
    screw = screw
    relative_angle = relative_angle
    anti_roll_bar = anti_roll_bar
