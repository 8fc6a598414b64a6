"""Numbers that only the users of a System need."""

from __future__ import annotations

from mbs.common.checks import number, shown, text
from mbs.model.records import Constant
from mbs.model.register import Register


class ConstantVocabulary(Register):
    """Constants."""

    def constant(self, name: str, value: float, unit: str = "1", description: str = "") -> Constant:
        """A number about the model that its users need and its equations do not, such as a wheelbase.

        An FMU has it as a constant; it is not an output and takes no part in a run.

        Parameters
        ----------
        name : str
            Unique, such as ``vehicle.wheelbase``.
        value : float
            Finite, in `unit`.
        unit : str
            SI unit.
        """
        what = f"constant {shown(name)}"
        constant = Constant(
            name,
            number(value, f"The value of {what}"),
            text(unit, f"The unit of {what}"),
            text(description, f"The description of {what}", lines=True),
        )
        return self.enter("constant", self.constants, constant)
