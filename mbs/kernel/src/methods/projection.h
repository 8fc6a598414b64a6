/* Projections (24), (25) of velocities and accelerations v (nq) onto the rows Phi_q v + b = 0, b (nc), with Phi_q in
 * in->tangent.J and the factorised tangent. Rows are closed if their violation is at most the tolerance times the
 * largest of v, or at most `round_off`, which positions leave in them, m/s or m/s^2. */
#ifndef ALI3_PROJECTION_H
#define ALI3_PROJECTION_H
#include "../algebra/real.h"
#include "../instance.h"

/* Whether they are closed; writes Phi_q v + b to in->step.mu and its size to *violation, m/s or m/s^2. */
ALI3_PER_WIDTH lane_mask ali3_rates_closed(ali3_instance *in, const real *b, const real *v, double tolerance,
                                           double round_off, real *violation);
/* Corrects v in at most `sweeps` solutions until the rows are closed; returns the violation. factor: weight of Phi_q'
 * Phi_q in that tangent, c alpha of a step or ALI3_INDEX_ONE_PENALTY; lam (nc), NULL for velocities: multipliers,
 * corrected too; `has_rates`: in->step.mu already holds Phi_q v. */
ALI3_PER_WIDTH real ali3_project(ali3_instance *in, double factor, const real *b, real *v, real *lam, double tolerance,
                                 double round_off, int32_t sweeps, bool has_rates);
#endif
