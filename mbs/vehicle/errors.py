"""Error and warning for car files."""

from mbs.common.errors import ModelError


class CarFileError(ModelError):
    """A car file cannot be read or does not describe a car; the message has a line for each fault."""


class CarWarning(UserWarning):
    """A number of a car is possible but unusual; the message names it and the usual range."""
