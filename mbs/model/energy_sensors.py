"""Sensors of energy, work and mass."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import overload

from mbs.common.checks import one_of, shown
from mbs.common.errors import ModelError
from mbs.elements.record import ElementRecord
from mbs.kernel.header.enumerations import SensorType
from mbs.model.sensor import Sensor
from mbs.model.sensors import SensorVocabulary

WORKS = ("work", "nonconservative", "by inputs")
GUIDED = "with guides"
ENERGIES = ("kinetic", "gravity", "elastic", "total")


@dataclass(frozen=True)
class _WorkIntegers(Sequence[int]):
    """Integers of a work sensor of all elements beginning with `first`, including elements that are added later."""

    elements: Sequence[ElementRecord]
    first: int

    def __len__(self) -> int:
        return 2 + len(self.elements) - self.first

    @overload
    def __getitem__(self, index: int) -> int: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[int]: ...
    def __getitem__(self, index: int | slice) -> int | Sequence[int]:
        numbers = range(self.first, len(self.elements))
        return [WORKS.index("nonconservative"), len(numbers), *numbers][index]


class EnergySensorVocabulary(SensorVocabulary):
    """Sensors of energy, mass and work of the whole model."""

    book_of_added: tuple[str, str] | None = None
    """Name and description of a sensor of the work of all elements added later; it is added with the first of them."""

    def add(self, element: ElementRecord) -> ElementRecord:
        """Add a force element by its record.

        Parameters
        ----------
        element : ElementRecord
            From the ``record`` method of an element of `mbs.elements`.
        """
        added = super().add(element)
        if self.book_of_added is not None:
            (name, description), self.book_of_added = self.book_of_added, None
            work = _WorkIntegers(self.elements, len(self.elements) - 1)
            self._sense(name, "J", description, SensorType.WORK, integers=work)
        return added

    def sense_energy(
        self,
        name: str,
        kind: str = "total",
        elements: ElementRecord | str | Sequence[ElementRecord | str] | None = None,
        *,
        unit: str = "J",
        description: str = "",
    ) -> Sensor:
        """Energy of the mechanism, or work of force elements on it since the start, J.

        The nonconservative work of all elements and the work of driven joints are the change of the total energy, but
        for the error of the steps (`sense_solver`, "energy_error"). Each method adds up the work of its own steps: with
        mean forces times displacements by the trapezoidal rule (second order), with the forces of discrete gradients by
        energy-momentum (exact), with powers of the stages by the others.

        Parameters
        ----------
        kind : {"kinetic", "gravity", "elastic", "total", "work", "nonconservative", "by inputs", "with guides"}
            The elastic energy is stored in springs and flexible bodies. Work is the work of all forces of the elements;
            nonconservative together with the change of their own potential energy, so that springs have none, but for
            the work of jumps of inputs, as of a `PortRoad`, which is "by inputs" (with the method "ali3p" and
            generalised-alpha; with others it stays nonconservative). Work that is lost, in a damper or a brake, is
            negative. "with guides" adds the work of all driving functions, which drive joints, to the nonconservative
            work of elements: with "ali3p" and its projections from the mean forces of a step, jumps of inputs with
            them; with others from the forces at both ends of a step, which differ from the mean where an input jumps.
        elements : ElementRecord, str or sequence of them
            Of a work: force elements of this model or their names, whose works are added; "with guides" needs none.

        Raises
        ------
        ModelError
            An element comes twice.
        """
        one_of(kind, (*ENERGIES, *WORKS, GUIDED), f"The energy of sensor '{name}'")
        if kind in ENERGIES:
            if elements is not None:
                raise ModelError(
                    f"The sensor '{name}' reads the {kind} energy, which is that of the whole mechanism; elements are "
                    "for 'work' and 'nonconservative'."
                )
            return self._sense(name, unit, description, SensorType.ENERGY, integers=[ENERGIES.index(kind)])
        guided = kind == GUIDED
        if guided and elements is None:
            elements = ()
        if not isinstance(elements, (ElementRecord, str, list, tuple)):
            raise ModelError(f"The sensor '{name}' needs force elements or their names, got {shown(elements)}.")
        requested = [elements] if isinstance(elements, (ElementRecord, str)) else list(elements)
        index_of = {record.name: k for k, record in enumerate(self.elements)}
        names = [e.name if isinstance(e, ElementRecord) else e for e in requested]
        for element in names:
            if not isinstance(element, str) or element not in index_of:
                raise ModelError(
                    f"The sensor '{name}' asks for element {shown(element)}, but the model has no such element; it "
                    f"has: {', '.join(index_of) or 'none'}."
                )
        if not (names or guided) or len(set(names)) < len(names):
            raise ModelError(f"The sensor '{name}' needs at least one element and each once, got {names}.")
        numbers = [index_of[element] for element in names]
        if guided:
            return self._sense(name, unit, description, SensorType.DRIVING_WORK, integers=[len(numbers), *numbers])
        return self._sense(
            name, unit, description, SensorType.WORK, integers=[WORKS.index(kind), len(numbers), *numbers]
        )

    def sense_mass(self, name: str, *, unit: str = "kg", description: str = "") -> Sensor:
        """Mass of all bodies and payloads, kg."""
        return self._sense(name, unit, description, SensorType.MASS)
