/* Work of force elements and of driving functions for sensors, J, by the quadrature of the method. Sensed elements:
 * n_work; their signals: n_work_force. */
#ifndef ALI3_WORK_H
#define ALI3_WORK_H
#include "../algebra/real.h"
#include "../instance.h"

/* Power of the driving functions at a state, W. */
double ali3_driving_power(ali3_instance *in, const ali3_vectors *v);
/* Adds work to that of the driving functions, if it is sensed. */
void ali3_driving_work(const ali3_instance *in, ali3_vectors *v, double work);

/* Resets the work at a start; the last ali3_forces was at v. */
void ali3_work_start(const ali3_instance *in, ali3_vectors *v);
/* Stores the forces and powers of sensed elements of the last ali3_forces, evaluated at v, in v->watched. */
void ali3_work_store(const ali3_instance *in, ali3_vectors *v);
/* Evaluates the forces at in->now with the inputs of the last step, for a method that did not make that step. */
void ali3_work_reopen(ali3_instance *in);
/* Adds the work from the state that in->next was extrapolated from, dt earlier, s. */
void ali3_work_extrapolated(ali3_instance *in, double dt);
/* Adds the change of potentials by a jump of the inputs at in->now, of which in->next is a copy; before, after_jump
 * (ne, J): potentials on both sides. */
void ali3_work_of_inputs(ali3_instance *in, const double *before, const double *after_jump);

/* For methods with forces at the ends or the middle of a step: adds the work of a step in->step.D from in->now to
 * in->next, with the mean of the forces at both ends (weight = 1/2) or the forces of the last ali3_forces (weight =
 * 1). */
void ali3_work_step(ali3_instance *in, double weight);
/* Displacements (n_work_force) of the signals of sensed elements along in->step.D. */
ALI3_PER_WIDTH void ali3_signal_displacements(const ali3_instance *in, real *displacement);
/* The same as ali3_work_step with the displacements in in->next.step_displacement. */
void ali3_work_along(ali3_instance *in, double weight);

/* For methods with stages: restores the powers at the start of a step that continues the last one. */
void ali3_work_recall(ali3_instance *in);
/* Sets in->watch.sum to the weight, s, times the powers of the last ali3_forces. */
void ali3_work_first(ali3_instance *in, double weight);
/* sum (n_work) += weight, s, times the powers (n_work) of a stage. */
void ali3_work_stage(const ali3_instance *in, double weight, const double *power, double *sum);

/* Work of n elements since the start, J; kind 0: work; 1: also the change of their potentials, without the part by
 * inputs; 2: that part. */
double ali3_work_sum(const ali3_instance *in, int32_t kind, int32_t n, const int32_t *element);
#endif
