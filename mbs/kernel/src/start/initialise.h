/* Start of a run at time t, s: consistent with the rows, or in static equilibrium. The functions return ALI3_OK or the
 * status of what failed. */
#ifndef ALI3_INITIALISE_H
#define ALI3_INITIALISE_H
#include "../elements/element.h"
#include "../instance.h"

/* Makes positions and velocities of in->now consistent, starts driving functions and elements, and computes
 * accelerations and multipliers. */
ali3_status ali3_solve_initial(ali3_instance *in, double t);
/* The same for given positions; `start` false: discrete states of elements, such as a gear, and their work are kept. */
ali3_status ali3_solve_rates(ali3_instance *in, bool start);
/* Moves in->now to a static equilibrium with residuals below the tolerance, m. */
ali3_status ali3_solve_static(ali3_instance *in, double t, double tolerance, int32_t max_iterations);
/* Moves a start to the equilibrium of the parameters, unless coordinates were set by the caller. */
ali3_status ali3_start_in_equilibrium(ali3_instance *in, double t);
/* As ali3_wheel_in_road; also updates the report of rims pressed into the road. */
ali3_status ali3_wheels_watch(ali3_instance *in);
/* Arguments for the check of element e at a start at q (nq) on `roads` (nr); writes its signals to u. */
ali3_element_args ali3_start_arguments(const ali3_instance *in, const ali3_road *roads, const double *q, int32_t e,
                                       double *u);
#endif
