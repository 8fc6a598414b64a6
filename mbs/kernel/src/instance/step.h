/* Work memory of a step: Newton's iteration, its tangent, the division of the step, and limits of its work. */
#ifndef ALI3_INSTANCE_STEP_H
#define ALI3_INSTANCE_STEP_H
#include <stdbool.h>
#include <stdint.h>

/* Most stages of runge_kutta.c, stages of radau.c, columns of ali3_tangent_work.local. */
enum { ALI3_STAGES = 12, ALI3_RADAU = 3, ALI3_LOCAL = 12 };

/* A step rule in the increment D: qd = rate D + hat, qdd = (D - d0) / c. The tangents of elements are c K + wC C. */
typedef struct {
  double c, rate, wC; /* s^2; 1/s; s */
} ali3_rule;

/* Vectors of the iteration, by the names of the theory; methods other than the paper's use them as scratch. */
typedef struct {
  double *D, *d0, *hat; /* nq: increment of q and terms of the rule, d0 as q, hat as qd */
  double *r, *x, *w; /* nq: residual, c times a force; right side and correction of D; scratch */
  double *Q; /* nq, N or N m: generalised forces */
  double *stage; /* ALI3_STAGES x nq: accelerations, of radau.c residuals too */
  double *shifted; /* nq: q shifted near the origin, see ../rows/constraints.c */
  double *Phi, *Phit; /* nc: stored rows, their partial derivative by the time */
  double *gamma, *mu; /* nc: Phi'' = Phi_q qdd + gamma; multipliers of the iterate, and rates of rows in projections */
  double *lam; /* nc: change of the multipliers */
  double *drive; /* nc: work of drives by a unit of the multipliers at the end of the step */
} ali3_iterate;

/* Correction and step of the last iteration, from which ../methods/accelerate.c extrapolates. */
typedef struct {
  double *correction_q, *step_q; /* nq */
  double *correction_lam, *step_lam; /* nc */
} ali3_mixing;

/* Phi_q (row pattern) and the tangent (front storage). */
typedef struct {
  double *J, *J_made; /* at the iterate; of the tangent in F */
  double *F; /* the tangent, then its factors */
  double *local; /* ALI3_LOCAL x max_front: unknowns of one front */
} ali3_tangent_work;

/* Division of a step, see ../methods/contact_event.c and abrupt_force.c. */
typedef struct {
  double event; /* fraction of the present part at which a stop is met or left */
  int32_t events_left; /* number of further divisions of the present step at events; negative: none are located */
  double changed; /* largest change of a judged force in the step, by ali3_divides; negative: not computed */
} ali3_parting;

/* Limits of the work of a step and of a call, and the residuals at these limits. */
typedef struct {
  int64_t iterations_before; /* report.iterations at the start of the present step */
  int64_t *work_left; /* remaining work of the caller, see ali3_count_work; NULL: no limit */
  bool capped; /* the present step ended at a limit, for example settings.step_iterations */
  double capped_residual; /* m: residual of that step */
  double call_residual; /* m: the largest of the steps of a call */
} ali3_work_bound;
#endif
