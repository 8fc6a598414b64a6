"""Several FMUs wired to a system: stepped together here, or written as an SSP for other programs."""

from hosts.systems.coupled_fmus import CoupledFmus
from hosts.systems.ssp import write_ssp

__all__ = ["CoupledFmus", "write_ssp"]
