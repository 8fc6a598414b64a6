/* Work memory of the methods. */
#ifndef ALI3_INSTANCE_METHODS_H
#define ALI3_INSTANCE_METHODS_H
#include "../../include/ali3.h"
#include "states.h"

/* energy_momentum.c */
typedef struct {
  double *middle, *rate; /* nq: position and velocity in the middle of the step */
  double *J0;            /* row pattern: Phi_q at the start */
  double *at_J0;         /* nq, ng, switches: state of J0 */
  bool has_J0;
  double *A, *A_made; /* row pattern: discrete derivative at the iterate, and of the tangent in F */
} ali3_discrete;

/* Guides in a step, ng each. */
typedef struct {
  double *mean;    /* mean rates */
  double *jump;    /* 2 ng: smallest jumps of rate and acceleration of guides of time that divide a step */
  double *follows; /* 1 if a filtered guide moves in the step, otherwise 0 */
} ali3_guide_work;

/* radau.c, one for each of ALI3_RADAU stages; empty with element states or filtered guides. */
typedef struct {
  double *Phi, *lam;   /* rows at the stages, multipliers */
  double *J, *J_made;  /* Phi_q at the stages, and of the tangent */
  double *x;           /* corrections */
  double *F, *F_C, *F_K; /* tangent of all stages; front storage of dampers and of springs and rows */
} ali3_radau;

/* branch_watch.c: signed squares, one for each triad. */
typedef struct {
  double *sine, *cosine; /* at in->now */
  double *sine_before, *sine_after, *sine_few; /* before the step, after it, after it in parts */
  double *left;               /* loops that left their modes */
  bool known, near;           /* `sine` belongs to in->now; branches may be close in the step */
  ali3_report report_before;  /* report before a step that may be repeated */
} ali3_branches;
#endif
