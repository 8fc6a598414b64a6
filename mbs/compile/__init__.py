"""compile(): from a model to a System."""

from mbs.compile.compile import compile

__all__ = ["compile"]
