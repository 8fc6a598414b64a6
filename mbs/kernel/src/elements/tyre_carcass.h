/* Carcass of a tyre of any formula: first-order deflections x of the patch, forward and left, between the horizontal
 * force F, N, on the wheel and the slip velocity v, m/s, of the patch; they are the same at standstill, rolling,
 * sliding and in the air.
 *
 * Per direction F = c x + d x' with the stiffness c and the damping d of the carcass. x = a + b x' over a step (theta
 * rule, a and b known) makes this F = c a + D x' with D = d + b c, and the steady force of the formula at
 * the slip velocity v + x' is F = F_steady(v) - g x' with the secant slip damping g. Both together have a solution that
 * is finite from g = 0 (air) to g = infinity (standstill).
 *
 * States, the first four of a tyre: both deflections, m, then their rates, m/s. */
#ifndef ALI3_TYRE_CARCASS_H
#define ALI3_TYRE_CARCASS_H
#include "element.h"

/* Carcass in a step, of both directions. */
typedef struct {
  real stiffness[2], damping[2]; /* c, N/m; d, N s/m */
  real offset[2], D[2]; /* c a, N; d + b c, N s/m */
} ali3_tyre_carcass;

/* Horizontal force at the end of a step, along forward and left of the patch. */
typedef struct {
  real F[2], J[2][2]; /* N; dF/dv, N s/m */
  real safe[2]; /* part of the secant damping that a tangent must have, N s/m */
} ali3_tyre_force;

/* Sets direction i of the carcass by c, d and g, and the safe part of its secant. */
ALI3_PER_WIDTH void ali3_tyre_carcass_at(const ali3_element_args *a, int i, real c, real d, real g,
                                         ali3_tyre_carcass *carcass, ali3_tyre_force *force);

/* Deflections and their rates at the end of the step by the forces F. */
ALI3_PER_WIDTH void ali3_tyre_deflect(ali3_element_args *a, const ali3_tyre_carcass *carcass, const real F[2]);

/* Damping matrix C = -dF/dv as xx, xy, yy: its symmetric part, positive semidefinite and not below the safe part of the
 * secant. */
ALI3_PER_WIDTH void ali3_tyre_damping(const ali3_tyre_force *force, real C[3]);
#endif
