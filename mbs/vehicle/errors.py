"""What is said about a car file that is wrong, or odd."""

from mbs.common.errors import ModelError


class CarFileError(ModelError):
    """A car file that cannot be read or does not describe a car; the message is for the user, a line for each fault."""


class CarWarning(UserWarning):
    """A car that can be but is odd; the message says which number, and what is usual."""
