"""Methods of the kernel by the titles of the charts, with settings that do not limit their order."""

import mbs
from mbs.settings.methods import METHOD_TABLE
from mbs.settings.settings import METHODS as KERNEL

TITLES = {name: method.title for name, method in METHOD_TABLE.items()}
TIGHT = {"tolerance_r": 1e-13, "tolerance_phi": 1e-13, "eps_rel": 1e-9}
"""Near a singular position the residual of a constraint decreases in an iteration by about eps_rel divided by the
square of its lever: with the default eps_rel the 200-four-bar does not reach 1e-13 m there within 30 iterations.
"""
CONSERVATIVE_ONLY = tuple(name for name, method in METHOD_TABLE.items() if method.conservative_only)
TREE_ONLY = tuple(name for name, method in METHOD_TABLE.items() if method.tree_only)
POSITIONS_ONLY = tuple(name for name, method in METHOD_TABLE.items() if method.positions_only)


def controlled(title: str) -> str:
    """Title of a method with error control."""
    return f"{title}, controlled"


def suits(name: str, conservative: bool, system: mbs.System) -> bool:
    """Whether a method can simulate a scene: some need no dissipation, a spanning tree, or no velocity constraints."""
    return (
        (conservative or name not in CONSERVATIVE_ONLY)
        and (not system.report["no_tree"] or name not in TREE_ONLY)
        and (len(system.arrays["velocity_row"]) == 0 or name not in POSITIONS_ONLY)
    )


def settings_of(name: str) -> dict[str, mbs.Settings]:
    """Settings of a method by title; of the default method also with tight tolerances."""
    title = TITLES.get(name, name)
    if name == "ali3p":
        return {title: mbs.Settings(method=name), f"{title}, tight": mbs.Settings(method=name, **TIGHT)}
    return {title: mbs.Settings(method=name)}


def all_settings(conservative: bool, system: mbs.System) -> dict[str, mbs.Settings]:
    """Settings by title of all methods that can simulate a scene."""
    names = [name for name in KERNEL if suits(name, conservative, system)]
    return {title: s for name in names for title, s in settings_of(name).items()}
