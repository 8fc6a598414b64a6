/* Energy errors of steps. */
#ifndef ALI3_ENERGY_WATCH_H
#define ALI3_ENERGY_WATCH_H
#include "../algebra/real.h"
#include "../instance.h"
#include "../request.h"

ALI3_PER_WIDTH real ali3_constraint_work(ali3_instance *in, double h, real *guides);
ALI3_PER_WIDTH real ali3_projection_work(ali3_instance *in, real *kinetic, real *end, real *open, real *guides);
ALI3_PER_WIDTH real ali3_energy_size(const ali3_instance *in, double h, real kinetic);
ali3_status ali3_energy_judge(ali3_instance *in, const ali3_request *request, double error, double size, double end,
                              double open, const double *weight);
ali3_status ali3_energy_watch(ali3_instance *in, const ali3_request *request, double error, double kinetic, double end,
                              double open);
void ali3_energy_trend(ali3_instance *in, bool balanced);
#endif
