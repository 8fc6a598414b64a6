/* Energy balance of a run, and other measures of the accuracy of its steps; energy_balance.c describes the functions. */
#ifndef ALI3_METHODS_ENERGY_BALANCE_H
#define ALI3_METHODS_ENERGY_BALANCE_H
#include "../instance.h"

double ali3_kinetic_energy(ali3_instance *in);
double ali3_energy(ali3_instance *in);
void ali3_balance_open(ali3_instance *in, bool balanced);
void ali3_balance_energy(ali3_instance *in, double error, double kinetic, const double *weight);
void ali3_balance_motion(ali3_instance *in, double speed, double change, double miss);
void ali3_balance_change(ali3_instance *in, double h, const double *v0, const double *a, const double *v1);
void ali3_balance_step(ali3_instance *in, double h);
void ali3_balance_long_step(ali3_instance *in, double h);
void ali3_balance_restore(ali3_report *report, const ali3_report *before);
#endif
