"""Register of a model: lists of its objects by kind, in the order of their addition."""

from collections.abc import Callable, Sequence
from typing import Any, Protocol, Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.checks import Vector, instance_of, named, shown
from mbs.common.errors import ModelError
from mbs.elements.record import ElementRecord
from mbs.elements.road import Road
from mbs.model.body import Body, Ground
from mbs.model.carried_parts import Payload, Spin, WrittenAxis, WrittenInertia
from mbs.model.changes import atomic_call
from mbs.model.checked_shapes import Shape, Turning
from mbs.model.coordinates import ModelCoordinates
from mbs.model.joints.joint import Joint
from mbs.model.records import Ahead, Armature, Constant, DrivingFunction, Input, Parameter, RoadFileParameter, Switch
from mbs.model.sensor import Sensor
from mbs.model.table_bodies import LookupTableBody, LookupTableNumber


class Named(Protocol):
    """An object that is registered by its name."""

    @property
    def name(self) -> str:
        """Unique in its family."""


N = TypeVar("N", bound=Named)
TIME = "time"
"""First column of tables of runs, and a variable of FMI 3.0."""
_VARIABLES = ("sensor", "input", "parameter", "constant")  # families whose names tables and FMUs share


class Register(ModelCoordinates):
    """Lists of all objects of a model, filled by the vocabulary and read by `compile`.

    There is one list for each kind; the index of an object in its list is its number in the System. A public method of
    a model that raises changes nothing: `atomic_call` wraps the methods of each vocabulary class when it is defined.
    """

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        for name, method in list(vars(cls).items()):
            if callable(method) and not name.startswith("_"):
                setattr(cls, name, atomic_call(method))

    def __init__(
        self, name: str, dimension: int = 3, gravity: ArrayLike | None = None, *, length: float | None = None
    ) -> None:
        super().__init__(name, dimension, gravity, length)
        self._names: dict[tuple[str, str], str] = {}  # families by kind and name
        # bodies and coordinates
        self.ground: Body = Ground(self, "ground", np.zeros(self.dimension), 0)
        self.bodies: list[Body] = []
        self.spins: list[Spin] = []
        self.lookup_tables: list[LookupTableBody | LookupTableNumber] = []
        self.payloads: list[Payload] = []
        self.armatures: list[Armature] = []
        self.inertias: dict[int, float] = {}  # by coordinate, with those of `armatures`, as drawn
        self.written_inertias: list[WrittenInertia] = []
        self.written_axes: list[WrittenAxis] = []
        # joints and forces
        self.joints: list[Joint] = []
        self.elements: list[ElementRecord] = []
        self.roads: list[Road] = []
        self.switches: list[Switch] = []
        self.grounded = False  # whether a joint is connected to the ground
        # inputs and outputs
        self.inputs: list[Input] = []
        self.guides: list[DrivingFunction] = []
        self.parameters: list[Parameter] = []
        self.road_files: list[RoadFileParameter] = []
        self.constants: list[Constant] = []
        self.sensors: list[Sensor] = []
        self.ahead: list[Ahead] = []
        self.with_ports = None
        # start and run
        self.floating = False
        self.body_velocities: dict[int, tuple[Vector | None, Vector | None]] = {}  # None: determined by the joints
        self.coordinate_rates: dict[int, float] = {}
        self.start_in_equilibrium = False
        self.equilibrium_parameters: dict[str, float] = {}  # values during its solution
        self.stop_time = 10.0
        self.step = 0.01
        # drawing
        self.default_shapes = True
        self._shapes: list[Shape] = []
        self._turnings: list[Turning] = []
        self.more_poses: list[Callable[[], list[dict[str, Any]]]] = []
        self.flexible_scene: list[dict[str, Any]] = []

    def unique(self, family: str, name: str) -> str:
        """Register a name in a family, such as body, joint, element or sensor, and return it.

        Raises
        ------
        ModelError
            The name is empty, cannot be written to a file, is the name of the time, or is taken.
        """
        key = "variable" if family in _VARIABLES else family, named(name, f"a {family}")
        if name == TIME and family in _VARIABLES:
            raise ModelError(f"The name of a {family} is '{TIME}', which tables of runs and FMUs have for their time.")
        if (taken := self._names.get(key)) is not None:
            raise ModelError(
                f"The model '{self.name}' already has {'an' if taken[0] in 'aei' else 'a'} {taken} named '{name}'; "
                f"names must be unique{'' if taken == family else ' in tables of runs and FMUs'}."
            )
        self._names[key] = family
        if self._undo is not None:
            self._undo.append(lambda: self._names.__delitem__(key))
        return key[1]

    def enter(self, family: str, items: list[N], item: N) -> N:
        """Add an item with a unique name to the list of a family, and return it."""
        self.unique(family, item.name)
        items.append(item)
        return item

    @staticmethod
    def place_of(items: Sequence[Named], name: object) -> int | None:
        """Index of the item of a name in the list of its family, or None."""
        return next((k for k, item in enumerate(items) if isinstance(name, str) and item.name == name), None)

    @property
    def shapes(self) -> list[Shape]:
        """All shapes, in the order in which they were added."""
        self.look()
        return self._shapes

    @property
    def turnings(self) -> list[Turning]:
        """Drawn parts that turn or slide."""
        self.look()
        return self._turnings

    @property
    def with_ports(self) -> Callable[[], Self] | None:
        """Function that makes the same model with ports; None if it was not set or the model has changed since."""
        return self._with_ports if self._counts() == self._size_with_ports else None

    @with_ports.setter
    def with_ports(self, make: Callable[[], Self] | None) -> None:
        self._with_ports, self._size_with_ports = make, self._counts()

    def _counts(self) -> tuple[int, ...]:
        """Numbers of bodies, joints, forces and other objects on which the equations depend."""
        lists = (
            self.bodies,
            self.lookup_tables,
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
        return tuple(len(objects) for objects in lists)

    @atomic_call
    def add(self, element: ElementRecord) -> ElementRecord:
        """Add a force element by its record. `element`: result of ``record`` of an element of `mbs.elements`."""
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


def owned(model: Register, entries: Sequence[N], given: N, kind: str, subject: str) -> N:
    """The given entry of a list of the model; raises `ModelError` if it is none.

    `kind`: name of an entry with its article.
    """
    if not any(entry is given for entry in entries):
        raise ModelError(f"{subject} needs {kind} made by model '{model.name}', got {shown(given)}.")
    return given
