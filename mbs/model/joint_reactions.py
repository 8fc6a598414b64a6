"""Forces and moments of joints and rods for sensors, as sums of multipliers times products of expressions.

A row Phi with the multiplier lam puts the generalised force -Phi_q' lam on its coordinates (M qdd + Phi_q' lam = Q);
a row u . v of vectors of both bodies exerts the moment -lam u x v on the first.
"""

from dataclasses import replace

import numpy as np

from mbs.common.affine import AffineVector
from mbs.model.body import Body
from mbs.model.joint_rotation import RotationConditions
from mbs.model.joints.joint import Joint
from mbs.model.sensor import Term


def fold_constants(term: Term) -> list[Term]:
    """The term with its constant factors moved to the weight; an empty list if it is zero."""
    weight, factors = term.weight, []
    for factor in term.factors:
        if factor.terms:
            factors.append(factor)
        else:
            weight *= factor.constant
    return [replace(term, weight=weight, factors=tuple(factors))] if weight != 0.0 else []


def driving_terms(joint: Joint, guide: int) -> list[Term]:
    """Force or torque on a driving function s from the rows of a joint: lam times their derivatives by s.

    The rows do no work on coordinates and driving function together, so with -Phi_q' lam on the coordinates the driving
    function takes lam dPhi/ds in the direction of its motion.
    """
    terms = []
    for row, equation in enumerate(joint.equations):
        for term in equation.guides:
            if term.guide != guide:
                continue
            weight, square = (1.0, -1) if term.power == 1 else (2.0, guide)
            for c, a, b in term.products:
                terms += fold_constants(Term(weight * c, row, (a, b), square, joint))
            terms += fold_constants(Term(weight, row, (term.linear,), square, joint))
    return terms


def force_on_first(joint: Joint) -> list[tuple[int, float, AffineVector]]:
    """Equation, weight and direction (earth axes) of each term of the force: the sum of weight lam direction."""
    rows = joint.force_equations
    if joint.normals:
        return [(row, -1.0, normal) for row, normal in zip(rows, joint.normals, strict=True)]
    directions = np.eye(len(rows))
    return [(row, -joint.rows_weight, AffineVector.constant(e)) for row, e in zip(rows, directions, strict=True)]


def moment_terms(
    joint: Joint, turning: RotationConditions, axis: AffineVector, about: AffineVector | None, on_first: bool
) -> list[Term]:
    """Terms of the moment of a joint on one of its bodies about a point (None: of the joint).

    `axis`: three components; in the plane one, about z.
    """
    sign = 1.0 if on_first else -1.0
    terms = []
    for row, (u, v, _) in zip(joint.turning_equations, turning.pairs, strict=True):
        terms += _cross_terms(row, -sign, u, v, axis)
    if about is None and (on_first or not joint.normals):
        return terms
    arm = turning.points[0] - (turning.points[1] if about is None else about)
    for row, weight, direction in force_on_first(joint):
        terms += _cross_terms(row, sign * weight, arm, direction, axis)
    return terms


def _cross_terms(row: int, weight: float, a: AffineVector, b: AffineVector, axis: AffineVector) -> list[Term]:
    """Terms of ``weight * lam * axis . (a x b)``; in the plane a x b is a number."""
    permutations = [(0, 0, 1)] if len(a) == 2 else [(k, (k + 1) % 3, (k + 2) % 3) for k in range(3)]
    terms = []
    for k, i, j in permutations:
        for first, second, sign in ((i, j, 1.0), (j, i, -1.0)):
            terms += fold_constants(Term(sign * weight, row, (axis[k], a[first], b[second])))
    return terms


def rod_terms(rod: Joint, body: Body, along: AffineVector) -> list[Term]:
    """Force of a massless rod on the body at one of its ends, along a vector: lam (p_1 - p_2) on the second end."""
    assert rod.ends is not None
    first, second = rod.ends.points
    sign = 1.0 if rod.ends.bodies[1] is body else -1.0
    gap = first - second
    return [t for k in range(len(gap)) for t in fold_constants(Term(sign, 0, (gap[k], along[k]), -1, rod))]
