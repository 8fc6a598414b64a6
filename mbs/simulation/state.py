"""Start pose and saved state of a run."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.common.checks import finite, number


@dataclass(frozen=True)
class Pose:
    """Start position, heading and speed of a scene that is not fixed to the ground.

    Raises
    ------
    ValueError
        One of them is not a finite number.
    """

    x: float = 0.0
    """Shift from the reference configuration along x of the earth, m."""
    y: float = 0.0
    """Shift along y, m."""
    z: float = 0.0
    """Shift along z, m."""
    yaw: float = 0.0
    """Turn about the vertical, rad."""
    speed: float = 0.0
    """Speed along the turned forward direction, wheels rolling, m/s."""
    lateral_speed: float = 0.0
    """Speed to the left, m/s."""
    yaw_rate: float = 0.0
    """Yaw rate, positive to the left, rad/s. Both speeds refer to the origin of the drawing, about which it turns."""

    def __post_init__(self) -> None:
        for name in ("x", "y", "z", "yaw", "speed", "lateral_speed", "yaw_rate"):
            check = number if name == "yaw" else finite  # the kernel refuses starts that are too far or too fast
            object.__setattr__(self, name, check(getattr(self, name), f"The {name} of a pose", ValueError))


@dataclass(frozen=True)
class State:
    """Position, velocity, acceleration (nq,), multipliers of the stored rows (nc,) and element states (ny,).

    Multipliers have the sign of ``M qdd + Phi_q' lam = Q``: a row Phi puts the force -Phi_q' lam on its
    coordinates. ``lam_user = row_scale * lam`` belongs to the row as the model writes it. The row of a drive is
    coordinate minus driving function, so the drive pushes the coordinate with -lam_user; the rows of a port and of a
    node of a flexible body are free point minus point of the body, so the body feels +lam_user; a distance of length L
    has the tension L lam_user. Sensors have the signs that their docstrings say.
    """

    q: NDArray[np.float64]
    qd: NDArray[np.float64]
    qdd: NDArray[np.float64]
    lam: NDArray[np.float64]
    y: NDArray[np.float64]
