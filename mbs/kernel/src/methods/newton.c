/* Functions common to Newton's iterations of all methods: the penalty, and the residual of an iterate. */
#include <math.h>

#include "../instance.h"
#include "../rows/violation.h"
#include "newton.h"

static const double MOST_STIFF = 100.0; /* a higher penalty would only bring round-off */

/* The rows are mass-normalised, so alpha is a squared frequency and alpha h^2 a pure number. Where flexible bodies
 * resist a row rather by their stiffness, K h^2/4 against M, the multipliers need a higher penalty to converge as
 * fast. */
double ali3_penalty(const ali3_instance *in, double h) {
  const ali3_settings *s = &in->settings;
  const double stiff = 0.25 * h * h * in->system->flex_rate;
  return s->alpha > 0.0 ? s->alpha : (1.0 + (stiff < MOST_STIFF ? stiff : MOST_STIFF)) / (s->eps_rel * h * h);
}

/* The balance r (nq) and the rows in in->step.Phi go into the report. Returns false when something is not finite. */
bool ali3_judge(ali3_instance *in, const double *r) {
  const ali3_system *S = in->system;
  in->report.residual = ali3_worst_size(r, in->mass.floor_inverse, S->size.nq, &in->report.worst_coordinate);
  in->report.violation = ali3_violation(S, in->step.Phi, &in->report.worst_row);
  return in->report.residual < 1e300 && in->report.violation < 1e300;
}

/* A correction could not be computed; where the iterates are far from the rows the tangent is not the cause. */
ali3_status ali3_newton_ended(const ali3_instance *in, ali3_status status) {
  return status == ALI3_SINGULAR && in->report.violation > ALI3_LOST * in->system->fine ? ALI3_NOT_CONVERGED : status;
}

/* One step has made its iterations; `before` it there were so many. */
void ali3_iterations_since(ali3_instance *in, int64_t before) {
  in->report.last_iterations = (int32_t)(in->report.iterations - before);
  if (in->report.last_iterations > in->report.max_iterations) in->report.max_iterations = in->report.last_iterations;
}
