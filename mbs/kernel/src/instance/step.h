/* Work memory of a step: Newton's iteration, its tangent, where the step is divided, and the limit of its work. */
#ifndef ALI3_INSTANCE_STEP_H
#define ALI3_INSTANCE_STEP_H
#include <stdbool.h>
#include <stdint.h>

enum { ALI3_STAGES = 12, ALI3_RADAU = 3, ALI3_LOCAL = 12 }; /* of runge_kutta.c, radau.c, fronts.c */

/* A step rule in the increment D: qd = rate D + hat, qdd = (D - d0) / c. The tangents of elements are c K + wC C. */
typedef struct {
  double c, rate, wC;
} ali3_rule;

/* Vectors of the iteration, by the names of the theory; methods other than the paper's use them as scratch. */
typedef struct {
  double *D, *d0, *hat; /* nq: increment and terms of the rule */
  double *r, *x, *w; /* nq: residual, right side and correction, scratch */
  double *Q; /* nq, N: generalised forces */
  double *stage; /* ALI3_STAGES x nq: accelerations, of radau.c residuals too */
  double *shifted; /* nq: q brought near the origin, see ../rows/constraints.c */
  double *Phi, *Phit; /* nc: rows, their partial rate */
  double *gamma, *mu; /* nc: Phi'' = Phi_q qdd + gamma; multipliers of the iterate */
  double *lam; /* nc: change of the multipliers */
  double *drive; /* nc: work of drives by a unit of the multipliers at the end */
} ali3_iterate;

/* Correction and step of the last iteration, from which ../methods/accelerate.c extrapolates. */
typedef struct {
  double *correction_q, *step_q; /* nq */
  double *correction_lam, *step_lam; /* nc */
} ali3_mixing;

/* Phi_q (row pattern) and the tangent (front storage). */
typedef struct {
  double *J, *J_made; /* at the iterate; where F was made */
  double *F; /* the tangent, then its factors */
  double *local; /* ALI3_LOCAL columns of a front */
} ali3_tangent_work;

/* Division of a step, see ../methods/contact_event.c and abrupt_force.c. */
typedef struct {
  double event; /* share of the present part at which a stop is met or left */
  int32_t events_left; /* how often the present step may still be divided at events; below 0: never */
  double changed; /* largest change of a judged force in the step, by ali3_divides; below 0: not known */
} ali3_parting;

/* Limits of the work of a step and of a call, and the residuals that they left. */
typedef struct {
  int64_t iterations_before; /* report.iterations where the present step began */
  int64_t *work_left; /* what the caller's call may still spend, see ali3_count_work; NULL: no limit */
  bool capped; /* the present step is less accurate because of a limit, as of settings.step_iterations */
  double capped_residual; /* m: what it then left */
  double call_residual; /* m: the largest of the steps of a call */
} ali3_work_bound;
#endif
