/* Projections (24), (25) of velocities and accelerations v (nq) onto the rows Phi_q v + b = 0, b (nc), with Phi_q in
 * in->tangent.J and the factorised tangent. Rows are closed if their violation is below the tolerance times the largest
 * of v, or below `known`, the round-off that positions leave in them. */
#ifndef ALI3_PROJECTION_H
#define ALI3_PROJECTION_H
#include "../algebra/real.h"
#include "../instance.h"

/* Whether they are closed; writes Phi_q v + b to in->step.mu and its size to *violation, m/s or m/s^2. */
ALI3_PER_WIDTH truth ali3_rates_closed(ali3_instance *in, const real *b, const real *v, double tolerance, double known,
                                       real *violation);
/* Corrects v in at most `sweeps` solutions until the rows are closed; returns the violation. factor: c alpha; lam (nc),
 * NULL for velocities: multipliers, corrected too; `begun`: in->step.mu already holds Phi_q v. */
ALI3_PER_WIDTH real ali3_project(ali3_instance *in, double factor, const real *b, real *v, real *lam, double tolerance,
                                 double known, int32_t sweeps, bool begun);
#endif
