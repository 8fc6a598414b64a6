/* Functions of Newton's iteration that all methods share: the penalty, and the residual of an iterate. */
#include <math.h>

#include "../instance.h"
#include "../rows/violation.h"
#include "newton.h"

static const double MAX_STIFFNESS = 100.0; /* a higher penalty increases round-off only */

/* Penalty alpha, 1/s^2. Rows are mass-normalised, so that alpha h^2 is dimensionless. Where the stiffness K h^2/4 of
 * flexible bodies exceeds their mass, the multipliers need a higher penalty to converge as fast. */
double ali3_penalty(const ali3_instance *in, double h) {
  const ali3_settings *s = &in->settings;
  const double stiffness = 0.25 * h * h * in->system->flex_rate;
  return s->alpha > 0.0 ? s->alpha
                        : (1.0 + (stiffness < MAX_STIFFNESS ? stiffness : MAX_STIFFNESS)) / (s->eps_rel * h * h);
}

bool ali3_measure_residual(ali3_instance *in, const double *r) {
  const ali3_system *S = in->system;
  in->report.residual = ali3_find_worst(r, in->mass.floor_inverse, S->size.nq, &in->report.worst_coordinate);
  in->report.violation = ali3_violation(S, in->step.Phi, &in->report.worst_row);
  return in->report.residual < 1e300 && in->report.violation < 1e300;
}

ali3_status ali3_newton_failure(const ali3_instance *in, ali3_status status) {
  return status == ALI3_SINGULAR && in->report.violation > ALI3_LOST * in->system->fine ? ALI3_NOT_CONVERGED : status;
}

void ali3_iterations_since(ali3_instance *in, int64_t before) {
  in->report.last_iterations = (int32_t)(in->report.iterations - before);
  if (in->report.last_iterations > in->report.max_iterations) in->report.max_iterations = in->report.last_iterations;
}
