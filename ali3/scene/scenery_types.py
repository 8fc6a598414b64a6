"""Types of scenery: objects and road paint that are drawn along a road and have no contact with wheels."""

from typing import Annotated, Literal

from pydantic import Field

from ali3.scene.scene_values import Number, Part, Positive, Text, Vector, Whole

Colour = Literal["white", "yellow", "red", "blue", "black"]
Points = Annotated[list[Vector], Field(min_length=2)]


class Line(Part):
    """A line painted on the ground."""

    kind: Literal["line"]
    points: Points
    """Of its middle, on the ground, m."""
    width: Positive
    colour: Colour = "white"
    dash: tuple[Positive, Positive] | None = None
    """Lengths that are painted and left out, m."""


class Upright(Part):
    """Fields of objects that stand upright at a point."""

    at: Vector
    """Its foot, on the ground, m."""


class Cone(Upright):
    """A traffic cone."""

    kind: Literal["cone"]
    height: Positive = 0.5
    colour: Literal["orange", "yellow", "blue"] = "orange"


class Tree(Upright):
    """A tree; its form follows from the seed."""

    kind: Literal["tree"]
    height: Positive
    seed: Whole = 0


class Sign(Upright):
    """A sign with words, to be read by who looks along its yaw."""

    kind: Literal["sign"]
    yaw: Number
    """Of the direction in which its reader looks, rad."""
    text: Text
    height: Positive = 2.5


class Barrier(Part):
    """A guard rail."""

    kind: Literal["barrier"]
    points: Points
    """Of its foot, on the ground, m."""
    height: Positive = 0.8


class Post(Upright):
    """A delineator post."""

    kind: Literal["post"]
    height: Positive = 1.0


class Building(Upright):
    """A box with a roof."""

    kind: Literal["building"]
    yaw: Number
    """Of its length, rad."""
    size: tuple[Positive, Positive, Positive]
    """Length, width and height, m."""


class GroundArrow(Upright):
    """An arrow painted on the ground."""

    kind: Literal["arrow"]
    yaw: Number
    """Of its direction, rad."""
    length: Positive = 4.0


AnyScenery = Annotated[Line | Cone | Tree | Sign | Barrier | Post | Building | GroundArrow, Field(discriminator="kind")]
