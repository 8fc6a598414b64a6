/* Work of force elements and of guides for sensors; work.c and signal_displacements.c describe the functions. */
#ifndef ALI3_WORK_H
#define ALI3_WORK_H
#include "../algebra/real.h"
#include "../instance.h"

double ali3_guides_power(ali3_instance *in, const ali3_vectors *v); /* W */
void ali3_guides_work(const ali3_instance *in, ali3_vectors *v, double work); /* adds work, if it is sensed */

/* Starts and ends of steps. */
void ali3_work_start(const ali3_instance *in, ali3_vectors *v);
void ali3_work_store(const ali3_instance *in, ali3_vectors *v);
void ali3_work_reopen(ali3_instance *in);
void ali3_work_beside(ali3_instance *in, double dt);
void ali3_work_of_inputs(ali3_instance *in, const double *before, const double *after_jump);

/* Methods with forces at the ends or the middle of a step: displacements (n_work_force) along in->step.D, and the work
 * along in->next.step_way. */
void ali3_work_step(ali3_instance *in, double weight);
ALI3_PER_WIDTH void ali3_signal_displacements(const ali3_instance *in, real *displacement);
void ali3_work_along(ali3_instance *in, double weight);

/* Methods with stages. */
void ali3_work_recall(ali3_instance *in);
void ali3_work_first(ali3_instance *in, double weight);
void ali3_work_stage(const ali3_instance *in, double weight, const double *power, double *sum);

/* Value of a sensor, J. */
double ali3_work_sum(const ali3_instance *in, int32_t kind, int32_t n, const int32_t *element);
#endif
