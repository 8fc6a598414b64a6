"""The methods of the kernel by the names of the charts, with the settings that let each show its order."""

from __future__ import annotations

import mbs
from mbs.settings import METHODS as KERNEL

TITLES = {
    "ali3p": "ALi3-P",
    "ali3p_no_projection": "ALi3 without projections",
    "ali3p_generalised_alpha": "ALi3-P, generalised-α",
    "energy_momentum": "energy-momentum",
    "energy_momentum_4": "energy-momentum, order 4",
    "runge_kutta_8": "Runge-Kutta, order 8",
    "semi_recursive": "semi-recursive, order 8",
    "semi_recursive_4": "semi-recursive, order 4",
    "radau_5": "Radau IIA, order 5",
}
TIGHT = {"tolerance_r": 1e-13, "tolerance_phi": 1e-13, "eps_rel": 1e-9}
"""Rows that a singular position nearly loses close by a factor of about eps_rel over the square of their lever in an
iteration: with the default eps_rel the 200-four-bar does not come below 1e-13 m there within 30 iterations."""
CONSERVATIVE_ONLY = ("energy_momentum_4",)
TREE_ONLY = ("semi_recursive", "semi_recursive_4")
POSITIONS_ONLY = ("radau_5",)


def controlled(title: str) -> str:
    """Title of a method under error control."""
    return f"{title}, controlled"


def suits(name: str, conservative: bool, system: mbs.System) -> bool:
    """Whether a method takes a scene: one without dissipation, with a spanning tree, without velocity rows."""
    return (
        (conservative or name not in CONSERVATIVE_ONLY)
        and (not system.report["no_tree"] or name not in TREE_ONLY)
        and (len(system.arrays["velocity_row"]) == 0 or name not in POSITIONS_ONLY)
    )


def settings_of(name: str) -> dict[str, mbs.Settings]:
    """Settings by title; the default method also with tight tolerances, which small errors need."""
    title = TITLES.get(name, name)
    if name == "ali3p":
        return {title: mbs.Settings(method=name), f"{title}, tight": mbs.Settings(method=name, **TIGHT)}
    return {title: mbs.Settings(method=name)}


def all_settings(conservative: bool, system: mbs.System) -> dict[str, mbs.Settings]:
    """All methods of the kernel that suit a scene."""
    names = [name for name in KERNEL if suits(name, conservative, system)]
    return {title: s for name in names for title, s in settings_of(name).items()}
