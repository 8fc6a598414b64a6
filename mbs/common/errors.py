"""Errors of models and of their arguments."""


class ModelError(ValueError):
    """An impossible model; the message names the component, its value and the valid values."""


class ArgumentTypeError(TypeError, ValueError):
    """An argument of a wrong type; the message names the type that is needed.

    It is a `TypeError`, as usual in Python, and a `ValueError`, as are the other errors of arguments in this package.
    """
