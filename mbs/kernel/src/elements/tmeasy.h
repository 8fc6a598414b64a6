/* TMeasy steady tyre characteristics (Hirschberg, Rill, Weinfurter, Vehicle System Dynamics 45(S1), 2007, 101-119). */
#ifndef ALI3_TMEASY_H
#define ALI3_TMEASY_H
#include "element.h"

typedef struct { /* one curve at the present load and friction; forces are divided by q = load / nominal load */
  real slope;                   /* initial slope dF/ds, N */
  real max_force, max_slip;     /* N, - */
  real slide_force, slide_slip; /* N, - */
} ali3_tmeasy;

typedef struct { /* curves of both directions as functions of the normalised slips n_i = s_i / scale_i */
  real max_force[2];       /* N, of each direction alone */
  real scale[2];           /* normalising factors of the slips */
  ali3_tmeasy square, spread; /* a parameter at the slip direction phi is sqrt(square + spread cos^2 phi) */
} ali3_tmeasy_pair;

/* Curve of one direction; pairs: slope, max_force, max_slip, slide_force, slide_slip, each at the nominal load and at
 * twice of it. */
ALI3_PER_WIDTH ali3_tmeasy ali3_tmeasy_at(const real pairs[10], real q, real friction_ratio);

/* Curves of both directions at one load and friction. */
ALI3_PER_WIDTH ali3_tmeasy_pair ali3_tmeasy_pair_at(const real x_pairs[10], const real y_pairs[10], real q,
                                                    real friction_ratio);

/* Secant F(s)/s of the generalised slip s = |n|, finite at s = 0, and its gradient by the normalised slips n; the force
 * is minus the secant times n. */
ALI3_PER_WIDTH real ali3_tmeasy_secant(const ali3_tmeasy_pair *t, const real n[2], real gradient[2]);

/* Dynamic trail divided by contact length at lateral slip s >= 0; pairs, each at the nominal load and at twice of
 * it: value at s = 0, slip of the first zero, slip from which it is 0. Both slips are proportional to the friction
 * ratio. */
ALI3_PER_WIDTH real ali3_tmeasy_trail(const real pairs[6], real q, real friction_ratio, real s);
#endif
