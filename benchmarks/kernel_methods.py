"""The methods of the kernel by the names of the charts, with the settings that let each show its order."""

from __future__ import annotations

import mbs
from mbs.settings import METHODS as KERNEL

TITLES = {
    "ali3p": "ALi3-P",
    "ali3p_no_projection": "ALi3 without projections",
    "ali3p_generalised_alpha": "ALi3-P, generalised-α",
    "ali3p_hht": "ALi3-P, HHT",
    "energy_momentum": "energy-momentum",
    "energy_momentum_4": "energy-momentum, order 4",
    "runge_kutta_8": "Runge-Kutta, order 8",
}
TIGHT = {"tolerance_r": 1e-13, "tolerance_phi": 1e-13, "eps_rel": 1e-9}
"""Rows that a singular position nearly loses close by a factor of about eps_rel over the square of their lever in an
iteration: with the default eps_rel the 200-four-bar does not come below 1e-13 m there within 30 iterations."""
CONSERVATIVE_ONLY = ("energy_momentum_4",)


def settings_of(name: str, conservative: bool) -> dict[str, mbs.Settings]:
    """Settings by title; the default method also with tight tolerances, which small errors need."""
    if name in CONSERVATIVE_ONLY and not conservative:
        return {}
    title = TITLES.get(name, name)
    if name == "ali3p":
        return {title: mbs.Settings(method=name), f"{title}, tight": mbs.Settings(method=name, **TIGHT)}
    return {title: mbs.Settings(method=name)}


def all_settings(conservative: bool) -> dict[str, mbs.Settings]:
    """All methods of the kernel that suit a scene."""
    return {title: s for name in KERNEL for title, s in settings_of(name, conservative).items()}
