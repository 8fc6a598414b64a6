"""The kinds of FMU by what they share: the one list for all tests."""

from fmu_src.build.build import KINDS

ALL = tuple(KINDS)
IN_C = tuple(kind for kind in ALL if kind != "python")
FMI_2 = ("native", "python")
VERSIONS = ("native", "fmi3")
"""One of each version of FMI."""
FACES = ("native", "fmi3_scalar")
"""One of each version of FMI, whose numbers have the same names: that of FMI 3.0 without arrays."""
BUILT = ("native", "fmi3", "python")
"""What ``ali3 build`` makes if nobody asks for a kind."""
