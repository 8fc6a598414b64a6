"""compile(): from a model to a System."""

from mbs.compiler.model_to_system import compile

__all__ = ["compile"]
