/* States to start from: on the rows, in equilibrium. */
#ifndef ALI3_INITIALISE_H
#define ALI3_INITIALISE_H
#include "../elements/element.h"
#include "../instance.h"

ali3_status ali3_solve_initial(ali3_instance *in, double t);
ali3_status ali3_solve_rates(ali3_instance *in, bool start);
ali3_status ali3_solve_static(ali3_instance *in, double t, double tolerance, int32_t max_iterations);
ali3_status ali3_start_in_equilibrium(ali3_instance *in, double t);
ali3_status ali3_wheels_watch(ali3_instance *in); /* ali3_wheel_in_road, and the report of rims */
/* Arguments of the check of a start of element e, at q on `roads`; its signals are written to u. */
ali3_element_args ali3_start_arguments(const ali3_instance *in, const ali3_road *roads, const double *q, int32_t e,
                                       double *u);
#endif
