"""Constants of a model for the users of its System."""

from mbs.common.checks import number, shown, text
from mbs.model.records import Constant
from mbs.model.register import Register


class ConstantVocabulary(Register):
    """Calls that add constants to a model."""

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
        subject = f"constant {shown(name)}"
        constant = Constant(
            name,
            number(value, f"The value of {subject}"),
            text(unit, f"The unit of {subject}"),
            text(description, f"The description of {subject}", lines=True),
        )
        return self.enter("constant", self.constants, constant)
