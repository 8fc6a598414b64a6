/* Work memory of the methods. */
#ifndef ALI3_INSTANCE_METHODS_H
#define ALI3_INSTANCE_METHODS_H
#include "../../include/ali3.h"
#include "states.h"

/* energy_momentum.c */
typedef struct {
  double *middle, *rate; /* nq: position and velocity in the middle of the step */
  double *J0;            /* row pattern: Phi_q at the start */
  double *at_J0; /* nq + ng + n_switch: coordinates, driving functions and switches at which J0 was evaluated */
  bool has_J0; /* J0 and at_J0 are set */
  double *A, *A_made; /* row pattern: discrete derivative at the iterate, and of the tangent in F */
} ali3_discrete;

/* Driving functions in a step, ng each. */
typedef struct {
  double *mean; /* mean rates over the step */
  double *least; /* 3 ng: departure and jumps of rate and acceleration of a function of time that divide a step */
  double *follows; /* 1 if a filtered driving function moves in the step, otherwise 0 */
} ali3_driving_arrays;

/* radau.c; arrays for ALI3_RADAU stages, one after the other, empty with element states or filtered driving
 * functions. */
typedef struct {
  double *Phi, *lam; /* nc a stage: rows, multipliers */
  double *J, *J_made; /* row pattern, a stage: Phi_q, and that of the tangent */
  double *x; /* nq a stage: corrections, interleaved coordinate by coordinate */
  double *F; /* ALI3_RADAU x ALI3_RADAU fronts: tangent of all stages */
  double *F_C, *F_K; /* front storage: tangents of dampers, and of springs and rows */
} ali3_radau;

/* branch_watch.c: signed squares of sines and cosines of the angles of joints, one for each triad. */
typedef struct {
  double *sine, *cosine; /* at the coordinates given last, see `known` */
  double *sine_before, *sine_after, *sine_few; /* before the step, after it, after it in parts */
  double *left; /* loops: 1 if the loop left its modes, otherwise 0 */
  bool known, near; /* `sine` belongs to in->now; branches may be close in the step */
  ali3_report report_before; /* report before a step that may be repeated */
} ali3_branches;
#endif
