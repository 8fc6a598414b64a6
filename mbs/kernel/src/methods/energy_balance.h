/* Accuracy measures of a run, in its report: energy balance, J, and the errors of predicted velocities. Squares of
 * velocities are weighted by masses, kg m^2/s^2. */
#ifndef ALI3_METHODS_ENERGY_BALANCE_H
#define ALI3_METHODS_ENERGY_BALANCE_H
#include "../instance.h"

/* Kinetic energy of in->now, J; prepares flexible and lookup-table bodies at in->now.q. */
double ali3_kinetic_energy(ali3_instance *in);
/* Kinetic and potential energy of in->now, J; updates report.kinetic_peak. */
double ali3_energy(ali3_instance *in);
/* Starts the measures at in->now; `balanced`: whether the method has an energy balance. */
void ali3_balance_start(ali3_instance *in, bool balanced);
/* Adds a step to in->next with its kinetic energy and energy error, J, to the balance; the remaining change of energy
 * is work. `weight`: potential energy of gravity, J; NULL: it is computed. */
void ali3_balance_energy(ali3_instance *in, double error, double kinetic, const double *weight);
/* Adds a step to the accuracy measures: squares of the velocity at its end (speed), of its change, and of the error of
 * the prediction v + h a (miss). */
void ali3_balance_motion(ali3_instance *in, double speed, double change, double miss);
/* The same for a step h, s, of natural coordinates from velocities v0 and accelerations a to velocities v1 (nq). */
void ali3_balance_change(ali3_instance *in, double h, const double *v0, const double *a, const double *v1);
/* The same for the step from in->next to in->now. */
void ali3_balance_step(ali3_instance *in, double h);
/* The same for a step that may be longer than an impact: with the accelerations of the end that predict worse. */
void ali3_balance_long_step(ali3_instance *in, double h);
/* Restores the measures as they were before a refused step. */
void ali3_balance_restore(ali3_report *report, const ali3_report *before);
#endif
