/* Work memory of single methods. */
#ifndef ALI3_INSTANCE_METHODS_H
#define ALI3_INSTANCE_METHODS_H
#include "../../include/ali3.h"
#include "states.h"

/* energy_momentum.c */
typedef struct {
  double *middle, *rate; /* nq: position and velocity in the middle of the step */
  double *J0;            /* row pattern: Phi_q at the start */
  double *at_J0;         /* nq, ng, switches: where J0 was made */
  bool has_J0;
  double *A, *A_made; /* row pattern: discrete derivative, and where F was made */
} ali3_discrete;

/* Guides in a step, ng each. */
typedef struct {
  double *mean;    /* mean rates */
  double *jump;    /* 2 ng: of rate and acceleration of guides of time, the least jump that ends a step */
  double *follows; /* 1 where a filtered guide moves in the step, else 0 */
} ali3_guide_work;

/* radau.c, ALI3_RADAU of each, empty where there are element states or filtered guides. */
typedef struct {
  double *Phi, *lam;   /* rows at the stages, multipliers */
  double *J, *J_made;  /* Phi_q at the stages, where the tangent saw it */
  double *x;           /* corrections */
  double *F, *F_C, *F_K; /* tangent of all stages; front storage of dampers and of springs and rows */
} ali3_radau;

/* branch_watch.c: signed squares; one of each triad. */
typedef struct {
  double *sine, *cosine; /* at in->now */
  double *sine_before, *sine_after, *sine_few; /* before the step, after it, after it in parts */
  double *left;               /* loops that left their modes */
  bool known, near;           /* `sine` is that of in->now; the step may be near a branch */
  ali3_report report_before;  /* of the step that may be repeated */
} ali3_branches;
#endif
