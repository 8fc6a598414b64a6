"""The shared scenes in Drake: its MultibodyPlant, stepped by its own Simulator, all compiled.

A continuous plant takes no constraints, so loops are closed by ball constraints of a discrete one (SAP, semi-implicit
Euler, of order one); the chain, which has no loop, is integrated by Drake's Runge-Kutta methods. Drake 1.51 crashes
with a ball constraint on the ground, so that Bricard's mechanism is excluded.
"""

import time

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.plant import DiscreteContactApproximation, MultibodyPlant
from pydrake.multibody.tree import FixedOffsetFrame, RevoluteJoint, RotationalInertia, SpatialInertia
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator

from benchmarks.peers.trees import Link, PeerRun, Tree, sample_times, tree_of

SAP = "SAP, semi-implicit Euler"
RUNGE_KUTTA = {"RK5": "runge_kutta5", "RK3": "runge_kutta3"}
DIVERGED = 1e3  # rad/s


def run(scene: str, h: float, end: float, samples: int, integrator: str) -> PeerRun:
    """Run a scene; only the steps count in the wall time."""
    if integrator not in integrators(scene):
        raise ValueError(f"{integrator!r} is not for {scene}")
    tree = tree_of(scene)
    plant = _build(tree, h if integrator == SAP else 0.0)
    simulator = Simulator(plant)
    if integrator != SAP:
        ResetIntegratorFromFlags(simulator, RUNGE_KUTTA[integrator], h)
        simulator.get_mutable_integrator().set_fixed_step_mode(True)
    context = simulator.get_mutable_context()
    plant.SetVelocities(context, np.array([link.rate for link in tree.links]))
    simulator.Initialize()
    body, world = plant.GetBodyByName(f"body {tree.body}").body_frame(), plant.world_frame()
    times, positions, wall = sample_times(end, samples), [], 0.0
    for t in times:
        begin = time.perf_counter()
        simulator.AdvanceTo(t)
        wall += time.perf_counter() - begin
        positions.append(plant.CalcPointsPositions(context, body, tree.point, world).ravel())
        if not np.abs(plant.GetVelocities(context)).max() < DIVERGED:
            break
    n = len(positions)
    return PeerRun(times[:n], np.array(positions)[:, tree.components], wall, n == samples + 1)


def integrators(scene: str) -> tuple[str, ...]:
    """Integrators of a scene: loops need the discrete plant."""
    if scene == "bricard":
        return ()
    return tuple(RUNGE_KUTTA) if scene == "spatial_chain" else (SAP,)


def _build(tree: Tree, step: float) -> MultibodyPlant:
    plant = MultibodyPlant(step)
    if step > 0.0:
        plant.set_discrete_contact_approximation(DiscreteContactApproximation.kSap)
    plant.mutable_gravity_field().set_gravity_vector(tree.gravity)
    bodies = [plant.world_body()]
    for number, link in enumerate(tree.links, start=1):
        bodies.append(plant.AddRigidBody(f"body {number}", _inertia(link)))
        base = FixedOffsetFrame(f"frame {number}", bodies[link.parent].body_frame(), RigidTransform(link.position))
        plant.AddJoint(RevoluteJoint(f"joint {number}", plant.AddFrame(base), bodies[-1].body_frame(), link.axis))
    for loop in tree.closures:
        plant.AddBallConstraint(bodies[loop.body_1], loop.point_1, bodies[loop.body_2], loop.point_2)
    plant.Finalize()
    return plant


def _inertia(link: Link) -> SpatialInertia:
    i = link.inertia
    central = RotationalInertia(i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2])
    return SpatialInertia.MakeFromCentralInertia(link.mass, link.centre, central)
