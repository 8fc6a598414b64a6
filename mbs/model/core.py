"""What a model consists of; the vocabulary in the other files writes into it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Self

from numpy.typing import ArrayLike

from mbs.common.checks import instance_of, shown
from mbs.common.errors import ModelError
from mbs.elements.record import ElementRecord
from mbs.elements.road import Road
from mbs.model.carried import Payload, Spin, WrittenAxis, WrittenInertia
from mbs.model.drawn import Shape, Turning
from mbs.model.joints.joint import Joint
from mbs.model.records import Ahead, Armature, Constant, Guide, Input, Parameter, RoadFileParameter, Switch
from mbs.model.register import Register
from mbs.model.sensor import Sensor
from mbs.model.tabled import TabledBody, TabledNumber


class ModelCore(Register):
    """What all parts of the vocabulary write into."""

    def __init__(self, name: str, dimension: int, gravity: ArrayLike | None, length: float | None) -> None:
        super().__init__(name, dimension, gravity, length)
        self.floating = False
        self.grounded = False  # a joint ties something to the ground
        self.start_in_equilibrium = False
        self.equilibrium_parameters: dict[str, float] = {}  # values that hold only while it is sought
        self.stop_time = 10.0
        self.step = 0.01
        self.joints: list[Joint] = []
        self.elements: list[ElementRecord] = []
        self.tabled: list[TabledBody | TabledNumber] = []
        self.inertias: dict[int, float] = {}  # with those of `armatures`, as drawn
        self.armatures: list[Armature] = []
        self.spins: list[Spin] = []
        self.inputs: list[Input] = []
        self.guides: list[Guide] = []
        self.switches: list[Switch] = []
        self.roads: list[Road] = []
        self.ahead: list[Ahead] = []
        self.road_files: list[RoadFileParameter] = []
        self.sensors: list[Sensor] = []
        self.payloads: list[Payload] = []
        self.written_inertias: list[WrittenInertia] = []
        self.written_axes: list[WrittenAxis] = []
        self.parameters: list[Parameter] = []
        self.constants: list[Constant] = []
        self._shapes: list[Shape] = []
        self._turnings: list[Turning] = []
        self.default_shapes = True
        self.more_poses: list[Callable[[], list[dict[str, Any]]]] = []
        self.flexible_scene: list[dict[str, Any]] = []
        self.with_ports = None

    @property
    def shapes(self) -> list[Shape]:
        """All shapes, in the order in which they were added."""
        self.look()
        return self._shapes

    @property
    def turnings(self) -> list[Turning]:
        """What only its looks turn or slide."""
        self.look()
        return self._turnings

    @property
    def with_ports(self) -> Callable[[], Self] | None:
        """Makes the same model with ports; None where there is none, or this one has grown since it was set."""
        return self._with_ports if self._size() == self._size_with_ports else None

    @with_ports.setter
    def with_ports(self, make: Callable[[], Self] | None) -> None:
        self._with_ports, self._size_with_ports = make, self._size()

    def _size(self) -> tuple[int, ...]:
        """Counts of what moves and what acts."""
        parts = (
            self.tabled,
            self.inertias,
            self.joints,
            self.elements,
            self.spins,
            self.inputs,
            self.guides,
            self.payloads,
            self.written_inertias,
            self.written_axes,
        )
        return tuple(len(part) for part in parts)

    def add(self, element: ElementRecord) -> ElementRecord:
        """Add a force element by its record. `element`: from the ``record`` method of an element of `mbs.elements`."""
        instance_of(ElementRecord, element, "The element of Model.add", "an ElementRecord")
        for signal in element.signals:
            self.expression(signal, f"The element '{element.name}'")
        return self.enter("element", self.elements, element)

    def _join(self, joint: Joint) -> Joint:
        """Add a joint."""
        return self.enter("joint", self.joints, joint)

    def joint_named(self, name: str) -> Joint:
        """The joint of a name."""
        k = self.place_of(self.joints, name)
        if k is None:
            raise ModelError(f"The model '{self.name}' has no joint named {shown(name)}.")
        return self.joints[k]
