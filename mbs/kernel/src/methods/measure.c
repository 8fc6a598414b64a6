/* What all methods share: M x, the penalty, and how far a vector or the rows are from good. */
#include <math.h>

#include "../ali3_internal.h"

static const double LOST = 1.0; /* m or so: rows this far open belong to an iteration that ran away */
static const double MOST_STIFF = 100.0; /* a higher penalty would only bring round-off */

bool ali3_finite(const double *v, int64_t n) {
  double sum = 0.0; /* x - x is 0 for finite x, NaN else */
  for (int64_t i = 0; i < n; i++) sum += v[i] - v[i];
  return sum == 0.0;
}

void ali3_constant_mass_times(const ali3_system *S, const double *x, double *out) {
  for (int32_t i = 0; i < S->size.nq; i++) {
    double sum = 0.0;
    for (int32_t k = S->mass_ptr[i]; k < S->mass_ptr[i + 1]; k++) sum += S->mass_val[k] * x[S->mass_col[k]];
    out[i] = sum;
  }
}

void ali3_mass_times(const ali3_instance *in, const double *x, double *out) {
  ali3_constant_mass_times(in->system, x, out);
  if (in->system->n_flexible > 0) ali3_flexible_mass_times(in, x, out);
}

/* a' M b, M of the last q prepared; M b stays in `work` (nq). */
double ali3_mass_product(const ali3_instance *in, const double *a, const double *b, double *work) {
  double sum = 0.0;
  ali3_mass_times(in, b, work);
  for (int32_t i = 0; i < in->system->size.nq; i++) sum += work[i] * a[i];
  return sum;
}

/* The rows are mass-normalised, so alpha is a squared frequency and alpha h^2 a pure number. Where flexible bodies
 * resist a row rather by their stiffness, K h^2/4 against M, the multipliers need a higher penalty to converge as
 * fast. */
double ali3_penalty(const ali3_instance *in, double h) {
  const ali3_settings *s = &in->settings;
  const double stiff = 0.25 * h * h * in->system->flex_rate;
  return s->alpha > 0.0 ? s->alpha : (1.0 + (stiff < MOST_STIFF ? stiff : MOST_STIFF)) / (s->eps_rel * h * h);
}

double ali3_violation(const ali3_system *S, const double *Phi, int32_t *worst) {
  double largest = 0.0;
  for (int32_t k = 0; k < S->size.nc; k++) {
    const double v = fabs(Phi[k]) * S->row_measure[k];
    if (!(v <= largest) && largest == largest) { /* a NaN stays */
      largest = v;
      *worst = k;
    }
  }
  return largest;
}

/* By how much the worst row is open beyond its round-off, m; of finite rows. */
double ali3_opening(const ali3_system *S, const double *Phi) {
  double largest = 0.0;
  for (int32_t k = 0; k < S->size.nc; k++) {
    const double v = fabs(Phi[k]) * S->row_measure[k] - S->row_round[k];
    if (v > largest) largest = v;
  }
  return largest;
}

bool ali3_closed(const ali3_system *S, const double *Phi, double tolerance) {
  for (int32_t k = 0; k < S->size.nc; k++)
    if (!(fabs(Phi[k]) * S->row_measure[k] <= tolerance + S->row_round[k])) return false;
  return true;
}

/* The balance r (nq) and the rows in in->Phi go into the report. Returns false when something is not finite. */
bool ali3_judge(ali3_instance *in, const double *r) {
  const ali3_system *S = in->system;
  double largest = 0.0;
  for (int32_t i = 0; i < S->size.nq; i++) {
    const double size = fabs(r[i]) * S->mass_floor_inverse[i];
    if (!(size <= largest) && largest == largest) { /* a NaN stays */
      largest = size;
      in->report.worst_coordinate = i;
    }
  }
  in->report.residual = largest;
  in->report.violation = ali3_violation(S, in->Phi, &in->report.worst_row);
  return in->report.residual < 1e300 && in->report.violation < 1e300;
}

/* A correction could not be made: where the iterates had left the rows far behind, not the tangent is to blame. */
ali3_status ali3_newton_ended(const ali3_instance *in, ali3_status status) {
  return status == ALI3_SINGULAR && in->report.violation > LOST ? ALI3_NOT_CONVERGED : status;
}

/* One step has made its iterations; `before` it there were so many. */
void ali3_iterations_since(ali3_instance *in, int64_t before) {
  in->report.last_iterations = (int32_t)(in->report.iterations - before);
  if (in->report.last_iterations > in->report.max_iterations) in->report.max_iterations = in->report.last_iterations;
}
