"""Flexible bodies: beam finite elements, Craig-Bampton reduction, shape integrals, stress recovery."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mbs.common.lazy_modules import lazy_modules
from mbs.flexible.craig_bampton import craig_bampton
from mbs.flexible.damping import RayleighDamping
from mbs.flexible.external_model import external_model, read_matrix, read_model
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.fixed_interface import Interface
from mbs.flexible.frame import Beam, Frame
from mbs.flexible.frequencies import natural_modes
from mbs.flexible.inertia_relief import InertiaRelief, inertia_relief
from mbs.flexible.load_path_modes import interface_loads, load_path_modes, reduced_eigenmodes
from mbs.flexible.material import Material
from mbs.flexible.mode_choice import ModeChoice, modes_for_output
from mbs.flexible.read_calculix import read_calculix
from mbs.flexible.read_nastran import read_nastran
from mbs.flexible.recovery import StrainGauge, gauge_rows, section_forces, stress_field
from mbs.flexible.reduced_body import InterfaceModes, ReducedBody
from mbs.flexible.section import Section, rectangle, round_bar, tube
from mbs.flexible.shape_integrals import ShapeIntegrals, shape_integrals

if TYPE_CHECKING:
    from mbs.flexible import scene_part as scene_part

__getattr__ = lazy_modules(__name__, ("scene_part",))

__all__ = [
    "Beam",
    "FiniteElementModel",
    "Frame",
    "InertiaRelief",
    "Interface",
    "InterfaceModes",
    "Material",
    "ModeChoice",
    "RayleighDamping",
    "ReducedBody",
    "Section",
    "ShapeIntegrals",
    "StrainGauge",
    "craig_bampton",
    "external_model",
    "gauge_rows",
    "inertia_relief",
    "interface_loads",
    "load_path_modes",
    "modes_for_output",
    "natural_modes",
    "read_calculix",
    "read_matrix",
    "read_model",
    "read_nastran",
    "rectangle",
    "reduced_eigenmodes",
    "round_bar",
    "section_forces",
    "shape_integrals",
    "stress_field",
    "tube",
]
