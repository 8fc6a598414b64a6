"""Tables of the page on finite elements, for the prototype's frame: mass models, modes, comparison with CalculiX."""

import json

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import spsolve

from benchmarks.car import calculix
from benchmarks.car.calculix import FRAME, INTERFACES, REFERENCE
from benchmarks.car.statics import interface_forces
from benchmarks.shared.pages import table
from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.frequencies import natural_modes
from mbs.flexible.load_paths import interface_loads, load_path_modes
from mbs.flexible.recovery import gauge_rows
from mbs.flexible.relief_solution import inertia_relief

Array = NDArray[np.float64]
DYNAMIC_MODES = FRAME.section.dynamic_modes
FIGURES = {
    "tube_tip_deflection_m": ("tube of 1.5 m, tip deflection under 100 N, mm", 1e3, ".3f", 1),
    "frame_torsional_stiffness_Nm_per_deg": ("frame, torsional stiffness, N m/deg", 1.0, ".0f", 1),
    "frame_loaded_free_hz": ("frame loaded, free, Hz", 1.0, ".2f", 1),
    "frame_bare_free_hz": ("frame bare, free, Hz", 1.0, ".2f", 1),
    "frame_gauge_moments_Nm": ("gauges at rest, front and rear, N m", 1.0, ".2f", 2),
}
"""Results in `calculix.STORED`: title, scale, format, and stride of the shown values."""
CONVERGED = 4  # refinement from which three digits of the moments at rest do not change


def moments(theory: str = "euler_bernoulli", refinement: int = 1) -> Array:
    """Moments at the gauges, N m, of the frame at rest on its suspension, by inertia relief."""
    frame, tubes = FRAME.frame(theory, refinement)
    rows, _ = gauge_rows(frame, FRAME.strain_gauges(tubes))
    relief = inertia_relief(frame.finite_element_model(), REFERENCE, INTERFACES, rows)
    return np.asarray(relief.balanced @ interface_forces(INTERFACES))


def moments_by_modes() -> dict[str, tuple[int, Array]]:
    """Number of modes and moments at the gauges of the frame at rest, N m, by set of modes."""
    frame, tubes = FRAME.frame()
    model, forces = frame.finite_element_model(), interface_forces(INTERFACES)
    rows, _ = gauge_rows(frame, FRAME.strain_gauges(tubes))
    acceleration = inertia_relief(model, REFERENCE, INTERFACES, rows).acceleration_of_forces @ forces
    load = -model.mass_matrix() @ model.rigid_motions(model.origin(REFERENCE)) @ acceleration
    load[np.concatenate([model.freedoms(n) for n in INTERFACES])] += forces
    bodies = {f"60 static, {n} dynamic": craig_bampton(model, REFERENCE, INTERFACES, n) for n in (5, 20, 40)}
    full = craig_bampton(model, REFERENCE, INTERFACES, DYNAMIC_MODES, inertia_modes=True)
    bodies["60 static, 5 dynamic, 6 inertia"] = full
    bodies["load paths"] = load_path_modes(full, interface_loads(full, {n: np.eye(3) for n in INTERFACES}))
    return {
        name: (body.n_modes, np.asarray(body.recovery(rows) @ np.linalg.solve(body.K, body.modes.T @ load)))
        for name, body in bodies.items()
    }


def modes_table() -> str:
    """Table of the moments at the gauges at rest by set of modes, and by inertia relief."""
    results: dict[str, tuple[int | None, Array]] = {**moments_by_modes(), "none: inertia relief": (None, moments())}
    rows = [{"modes": n, "number": k, "SG1, SG2, N m": m[0], "SG3, SG4, N m": m[2]} for n, (k, m) in results.items()]
    return table(rows, {"modes": "", "number": "d", "SG1, SG2, N m": ".2f", "SG3, SG4, N m": ".2f"})


def tube_figures() -> tuple[float, Array]:
    """Tip deflection, m, and three natural frequencies, Hz, of the clamped tube."""
    model = calculix.cantilever(16).finite_element_model()
    F = np.zeros(model.n_dof)
    F[-4] = calculix.TIP_FORCE
    u = spsolve(sp.csc_matrix(model.K[6:][:, 6:]), F[6:])
    return float(u[-4]), natural_modes(model, 6, np.arange(6))[0][::2]


def frame_figures(theory: str) -> dict[str, Array]:
    """Results of `calculix.STORED` for the frame, by a beam theory with two elements for each."""
    frame, _ = FRAME.frame(theory, 2)
    model = frame.finite_element_model()
    bare = FRAME.frame(theory, 2, carried_masses=False)[0].finite_element_model()
    fixed_dofs = np.concatenate([model.freedoms("TRL"), model.freedoms("TRR"), model.freedoms(REFERENCE)[1:2]])
    free_dofs = np.setdiff1d(np.arange(model.n_dof), fixed_dofs)
    left, right = (model.freedoms(n)[2] for n in ("TFL", "TFR"))
    F, u = np.zeros(model.n_dof), np.zeros(model.n_dof)
    F[left], F[right] = calculix.TOWER_FORCE, -calculix.TOWER_FORCE
    u[free_dofs] = spsolve(sp.csc_matrix(model.K[free_dofs][:, free_dofs]), F[free_dofs])
    return {
        "frame_torsional_stiffness_Nm_per_deg": np.array(calculix.torsional_stiffness(frame, u[left] - u[right])),
        "frame_loaded_free_hz": natural_modes(model, 11)[0][6:],
        "frame_bare_free_hz": natural_modes(bare, 10)[0][6:],
        "frame_gauge_moments_Nm": moments(theory, 2),
    }


def calculix_table() -> str:
    """Table of CalculiX beside two beam theories; moments at rest of a converged mesh."""
    stored = json.loads(calculix.STORED.read_text(encoding="utf-8"))
    tube, steel = calculix.SECTIONS["M"], calculix.STEEL
    bending_deflection = calculix.TIP_FORCE * calculix.TUBE_LENGTH**3 / (3.0 * steel.E * tube.Iy)
    theories = {
        "Timoshenko": ("timoshenko", tube_figures()[0]),
        "Euler-Bernoulli": ("euler_bernoulli", bending_deflection),
    }
    columns = {"CalculiX": {name: np.asarray(stored[name]["extrapolated"]) for name in FIGURES}}
    for title, (theory, deflection) in theories.items():
        figures = frame_figures(theory) | {"frame_gauge_moments_Nm": moments(theory, CONVERGED)}
        columns[title] = figures | {"tube_tip_deflection_m": np.array(deflection)}
    rows = []
    for name, (title, scale, form, every) in FIGURES.items():
        cells = {
            column: ", ".join(f"{scale * x:{form}}" for x in np.atleast_1d(columns[column][name])[::every])
            for column in ("Timoshenko", "CalculiX", "Euler-Bernoulli")
        }
        rows.append({"quantity": title, **cells})
    return table(rows, dict.fromkeys(rows[0], ""))
