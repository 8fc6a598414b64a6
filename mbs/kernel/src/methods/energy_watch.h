/* Energy that constraint forces and projections bring into a step. */
#ifndef ALI3_ENERGY_WATCH_H
#define ALI3_ENERGY_WATCH_H
#include "../instance.h"

double ali3_constraint_work(ali3_instance *in, double h);
double ali3_projection_work(ali3_instance *in, double h, double *kinetic, double *end, double *open);
ali3_status ali3_energy_watch(ali3_instance *in, double h, double error, double kinetic, double end, double open);
#endif
