/* Energy errors of steps, J, from in->now to in->next; see constraint_work.c for the theory. */
#ifndef ALI3_ENERGY_WATCH_H
#define ALI3_ENERGY_WATCH_H
#include "../algebra/real.h"
#include "../instance.h"
#include "../request.h"

/* Energy error of a step h, s, before the projections; adds the work of drives to *driving_work and writes Phi_q v to
 * in->step.mu. Needs in->tangent.J and in->step.Phit at the end of the step, and the multipliers of Newton's
 * iteration. */
ALI3_PER_WIDTH real ali3_constraint_work(ali3_instance *in, double h, real *driving_work);
/* Energy error of the projections. *kinetic: kinetic energy of the mean of the velocities before and after (24), *end:
 * that after (24) without the square of its change, both J; *open: power of the forces that (25) leaves unbalanced, W;
 * adds the work of drives to *driving_work. */
ALI3_PER_WIDTH real ali3_projection_work(ali3_instance *in, real *kinetic, real *end, real *open, real *driving_work);
/* Reference for energy errors, J: the kinetic energy, the energy that the forces in in->step.Q can add in a step, and
 * that of the residual's tolerance. */
ALI3_PER_WIDTH real ali3_energy_size(const ali3_instance *in, double h, real kinetic);
/* Adds an energy error to the balance and, if no row is driven, refuses the step, or with limited iterations marks it
 * as capped, if it is large relative to `size`, J, or if it would be with the unbalanced power `open`, W, in a next
 * step of this size. `end`: kinetic energy at its end, J; `weight`: as in ali3_balance_energy. Returns ALI3_OK,
 * ALI3_UNRESOLVED or ALI3_NOT_FINITE. */
ali3_status ali3_energy_judge(ali3_instance *in, const ali3_request *request, double error, double size, double end,
                              double open, const double *weight);
/* The same with the reference of ali3_energy_size; `kinetic`: its argument. */
ali3_status ali3_energy_watch(ali3_instance *in, const ali3_request *request, double error, double kinetic, double end,
                              double open);
/* Updates the linear trend of the energy of conservative Systems; `balanced`: report.energy is that of in->now. */
void ali3_energy_trend(ali3_instance *in, bool balanced);
#endif
