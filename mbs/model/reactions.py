"""Joint forces and moments for sensors, as sums of multipliers times products of expressions.

A row Phi with the multiplier lam puts the generalised force -Phi_q' lam on its coordinates (M qdd + Phi_q' lam = Q).
"""

from dataclasses import replace

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


def guide_terms(joint: Joint, guide: int) -> list[Term]:
    """Force or torque on a guide from the rows of a joint: lam times their derivatives with respect to the guide.

    The rows do no work on coordinates and guide together, so with -Phi_q' lam on the coordinates the guide takes
    lam dPhi/ds in the direction of its motion.
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
