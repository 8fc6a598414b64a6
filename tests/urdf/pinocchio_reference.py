"""Torques of two robots by Pinocchio, which are stored: python -m tests.urdf.pinocchio_reference, where `pin` is."""

import tempfile
from pathlib import Path

import numpy as np

from tests.urdf.robots import ROBOTS, states, write_urdf

DATA = Path(__file__).parents[1] / "data" / "urdf"


def main() -> None:
    """Write a table for each robot: a row a state, a column a joint, N m."""
    import pinocchio

    for name, links in ROBOTS.items():
        file = write_urdf(links, Path(tempfile.mkdtemp()) / f"{name}.urdf")
        model = pinocchio.buildModelFromUrdf(str(file))
        rows = [pinocchio.rnea(model, model.createData(), *state) for state in states(name)]
        header = f"rnea of Pinocchio {pinocchio.__version__}, N m"
        np.savetxt(DATA / f"{name}_rnea.csv", rows, "%.17g", ",", header=header)


if __name__ == "__main__":
    main()
