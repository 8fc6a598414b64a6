"""The shared scenes in Exudyn: planar bodies with revolute joints and a sparse solver, or a kinematic tree.

A run is one call of its compiled solver; only the position of the output point at the samples is recorded.
"""

import time
from typing import Any

import exudyn as exu
import numpy as np
from exudyn import itemInterface

from benchmarks.peers.trees import PeerRun, Tree, Vector, sample_times, tree_of
from mbs.scenes import bricard


def integrators(scene: str) -> tuple[str, ...]:
    """Integrators of a scene: explicit ones need a scene without loops; the trapezoidal rule of index 2 fails at
    singular positions and with redundant constraints.
    """
    if scene == "spatial_chain":
        return ("generalised alpha", "trapezoidal index 2", "RK44 (tree)")
    if scene == "double_four_bar":
        return ("generalised alpha", "generalised alpha (tree)")
    return ("generalised alpha",)


def run(scene: str, h: float, end: float, samples: int, integrator: str) -> PeerRun:
    """Run a scene; only the solver's call counts in the wall time."""
    explicit = integrator.startswith("RK44")
    if integrator not in integrators(scene):
        raise ValueError(f"{integrator!r} is not for {scene}")
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    tree = tree_of(scene)
    columns = tree.components
    if "four_bar" in scene and "(tree)" not in integrator:
        sensor, columns = _add_four_bar(mbs, len(tree.closures)), [0, 1]
    else:
        sensor = _add_closed_tree(mbs, scene, tree)
    large = len(tree.closures) > 10
    mbs.Assemble()
    s = exu.SimulationSettings()
    s.timeIntegration.numberOfSteps = round(end / h)
    s.timeIntegration.endTime = end
    s.timeIntegration.verboseMode = 0
    s.show.statistics = False
    s.solution.file.write = False
    s.solution.sensors.writePeriod = end / samples
    s.timeIntegration.newton.useModifiedNewton = True
    s.timeIntegration.newton.relativeTolerance = 1e-8  # its default
    s.timeIntegration.newton.absoluteTolerance = 1e-10
    s.timeIntegration.generalizedAlpha.spectralRadius = 1.0 if integrator.startswith("trap") else 0.9
    s.timeIntegration.generalizedAlpha.useIndex2Constraints = integrator.startswith("trap")
    s.timeIntegration.generalizedAlpha.useNewmark = integrator.startswith("trap")
    s.linearSolver.ignoreSingularJacobian = scene == "bricard"
    s.linearSolver.solverType = exu.LinearSolverType.EigenSparse if large else exu.LinearSolverType.EXUdense
    if scene == "bricard":
        s.linearSolver.solverType = exu.LinearSolverType.EigenDense
    kind = exu.DynamicSolverType.RK44 if explicit else exu.DynamicSolverType.GeneralizedAlpha
    begin = time.perf_counter()
    try:
        finished = bool(mbs.SolveDynamic(s, solverType=kind, showHints=False, showCausingItems=False))
    except Exception:  # the engine raises exceptions of several types when Newton's method fails
        finished = False
    wall = time.perf_counter() - begin
    table = np.atleast_2d(mbs.GetSensorStoredData(sensor))
    count = min(len(table), samples + 1)
    times = sample_times(end, samples)[:count]
    return PeerRun(times, table[:count, 1:][:, columns], wall, finished and count > samples)


def _add_four_bar(mbs: Any, windows: int) -> int:
    ground = mbs.AddObject(itemInterface.ObjectGround())
    tips: list[int] = []
    first = None
    for i in range(windows + 1):
        body = _planar_body(mbs, (i, 0.5), (0.5, 0.0), -1.0)
        base = mbs.AddMarker(itemInterface.MarkerBodyPosition(bodyNumber=body, localPosition=[0, -0.5, 0]))
        foot = mbs.AddMarker(itemInterface.MarkerBodyPosition(bodyNumber=ground, localPosition=[i, 0, 0]))
        mbs.AddObject(itemInterface.ObjectJointRevolute2D(markerNumbers=[base, foot]))
        tips.append(mbs.AddMarker(itemInterface.MarkerBodyPosition(bodyNumber=body, localPosition=[0, 0.5, 0])))
        if first is None:
            first = mbs.AddSensor(
                itemInterface.SensorBody(
                    bodyNumber=body,
                    localPosition=[0, 0.5, 0],
                    storeInternal=True,
                    outputVariableType=exu.OutputVariableType.Position,
                )
            )
    for i in range(windows):
        body = _planar_body(mbs, (i + 0.5, 1.0), (1.0, 0.0), 0.0)
        for side, tip in ((-0.5, tips[i]), (0.5, tips[i + 1])):
            end = mbs.AddMarker(itemInterface.MarkerBodyPosition(bodyNumber=body, localPosition=[side, 0, 0]))
            mbs.AddObject(itemInterface.ObjectJointRevolute2D(markerNumbers=[end, tip]))
    return int(first)


def _planar_body(mbs: Any, position: tuple[float, float], velocity: tuple[float, float], rate: float) -> int:
    node = mbs.AddNode(
        itemInterface.NodeRigidBody2D(referenceCoordinates=[*position, 0.0], initialVelocities=[*velocity, rate])
    )
    body = mbs.AddObject(itemInterface.ObjectRigidBody2D(physicsMass=1.0, physicsInertia=1.0 / 12.0, nodeNumber=node))
    centre = mbs.AddMarker(itemInterface.MarkerBodyMass(bodyNumber=body))
    mbs.AddLoad(itemInterface.LoadMassProportional(markerNumber=centre, loadVector=[0, -9.81, 0]))
    return int(body)


def _add_tree(mbs: Any, tree: Tree) -> tuple[int, int]:
    """Add a kinematic tree and its sensor; each joint axis is the third axis of its link's frame."""
    n = len(tree.links)
    frames = [_frame(link.axis) for link in tree.links]
    before = [np.eye(3) if link.parent == 0 else frames[link.parent - 1] for link in tree.links]
    node = mbs.AddNode(
        itemInterface.NodeGenericODE2(
            referenceCoordinates=[0.0] * n,
            initialCoordinates=[0.0] * n,
            initialCoordinates_t=[link.rate for link in tree.links],
            numberOfODE2Coordinates=n,
        )
    )
    inertias, transformations = exu.Matrix3DList(), exu.Matrix3DList()
    coms, offsets = exu.Vector3DList(), exu.Vector3DList()
    for link, R, R_before in zip(tree.links, frames, before, strict=True):
        inertias.Append(R.T @ link.inertia @ R)
        coms.Append(R.T @ link.centre)
        transformations.Append(R_before.T @ R)
        offsets.Append(R_before.T @ link.position)
    kinematic_tree = mbs.AddObject(
        itemInterface.ObjectKinematicTree(
            nodeNumber=node,
            jointTypes=[exu.JointType.RevoluteZ] * n,
            linkParents=[link.parent - 1 for link in tree.links],
            jointTransformations=transformations,
            jointOffsets=offsets,
            linkInertiasCOM=inertias,
            linkCOMs=coms,
            linkMasses=[link.mass for link in tree.links],
            baseOffset=[0.0, 0.0, 0.0],
            gravity=tree.gravity.tolist(),
        )
    )
    sensor = mbs.AddSensor(
        itemInterface.SensorKinematicTree(
            objectNumber=kinematic_tree,
            linkNumber=tree.body - 1,
            localPosition=frames[tree.body - 1].T @ tree.point,
            storeInternal=True,
            outputVariableType=exu.OutputVariableType.Position,
        )
    )
    return int(kinematic_tree), int(sensor)


def _link_marker(mbs: Any, tree_object: int, tree: Tree, body: int, point: Vector) -> int:
    """Add a marker at a point of a link."""
    local = _frame(tree.links[body - 1].axis).T @ point
    return int(
        mbs.AddMarker(
            itemInterface.MarkerKinematicTreeRigid(objectNumber=tree_object, linkNumber=body - 1, localPosition=local)
        )
    )


def _frame(axis: Vector) -> Vector:
    """Rotation matrix with the axis as its third column."""
    z = np.asarray(axis, float) / np.linalg.norm(axis)
    x = np.cross([0.0, 1.0, 0.0] if abs(z[1]) < 0.9 else [1.0, 0.0, 0.0], z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def _add_closed_tree(mbs: Any, scene: str, tree: Tree) -> int:
    """Add a tree with loops closed by a hinge in Bricard's mechanism, otherwise by points in the plane of the links."""
    tree_object, sensor = _add_tree(mbs, tree)
    if scene == "bricard":
        loop, hinge = tree.closures[0], _frame(np.array(bricard.AXES[5], float))
        end = _link_marker(mbs, tree_object, tree, loop.body_1, loop.point_1)
        ground = mbs.AddObject(itemInterface.ObjectGround())
        foot = mbs.AddMarker(itemInterface.MarkerBodyRigid(bodyNumber=ground, localPosition=loop.point_2))
        hinge_on_link = _frame(tree.links[loop.body_1 - 1].axis).T @ hinge
        mbs.AddObject(
            itemInterface.GenericJoint(
                markerNumbers=[end, foot],
                constrainedAxes=[1, 1, 1, 1, 1, 0],
                rotationMarker0=hinge_on_link,
                rotationMarker1=hinge,
            )
        )
        return sensor
    for loop in tree.closures:
        far = _link_marker(mbs, tree_object, tree, loop.body_1, loop.point_1)
        tip = _link_marker(mbs, tree_object, tree, loop.body_2, loop.point_2)
        mbs.AddObject(itemInterface.GenericJoint(markerNumbers=[far, tip], constrainedAxes=[1, 1, 0, 0, 0, 0]))
    return sensor
