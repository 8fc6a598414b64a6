"""What is right: exact motions, published numbers, stored runs of independent programs, and their scenes."""

from benchmarks.references.motions import (
    BICYCLE,
    equal_arms,
    four_bar,
    light_cart,
    minimum_norm,
    minimum_norm_motion,
    one_degree,
    pendulum,
    rolling_bicycle,
    spatial_crank,
)

__all__ = [
    "BICYCLE",
    "equal_arms",
    "four_bar",
    "light_cart",
    "minimum_norm",
    "minimum_norm_motion",
    "one_degree",
    "pendulum",
    "rolling_bicycle",
    "spatial_crank",
]
