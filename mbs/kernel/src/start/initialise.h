/* Start of a run: consistent with the rows, or in static equilibrium. */
#ifndef ALI3_INITIALISE_H
#define ALI3_INITIALISE_H
#include "../elements/element.h"
#include "../instance.h"

ali3_status ali3_solve_initial(ali3_instance *in, double t);
ali3_status ali3_solve_rates(ali3_instance *in, bool start);
ali3_status ali3_solve_static(ali3_instance *in, double t, double tolerance, int32_t max_iterations);
ali3_status ali3_start_in_equilibrium(ali3_instance *in, double t);
ali3_status ali3_wheels_watch(ali3_instance *in); /* as ali3_wheel_in_road; also updates the report of pressed rims */
/* Arguments for the start check of element e at q on `roads`; writes its signals to u. */
ali3_element_args ali3_start_arguments(const ali3_instance *in, const ali3_road *roads, const double *q, int32_t e,
                                       double *u);
#endif
