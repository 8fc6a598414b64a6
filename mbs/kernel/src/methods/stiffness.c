/* Cause for which an explicit method refused a step: the fastest rate of change of the motion beside the step. */
#include <math.h>
#include <string.h>

#include "../instance.h"
#include "../method.h"
#include "../start/index_one.h"
#include "../state/vectors.h"
#include "stiffness.h"

enum { ROUNDS = 24, COUNTED = 8 }; /* the eighth root is three square roots */
static const double SHIFT = 1e-7; /* of the size of the state, at least 1 */
static const double RESOLVED = 1.0; /* step times rate at which no stage runs away by itself */

static double length(const double *x, int32_t n) {
  double sum = 0.0;
  for (int32_t i = 0; i < n; i++) sum += x[i] * x[i];
  return sqrt(sum);
}

/* Accelerations at now + scale (x, v) into out (nq); in->next is scratch. */
static bool accelerations(ali3_instance *in, const double *x, const double *v, double scale, double *out) {
  const int32_t nq = in->system->size.nq;
  ali3_vectors_copy(in, &in->next, &in->now);
  for (int32_t i = 0; i < nq; i++) {
    in->next.q[i] += scale * x[i];
    in->next.qd[i] += scale * v[i];
  }
  if (ali3_index_one(in, &in->next) != ALI3_OK) return false;
  memcpy(out, in->next.qdd, (size_t)nq * sizeof *out);
  return true;
}

/* Largest eigenvalue, in size, of the equations of index one about in->now, 1/s, by power iteration with differences;
 * the geometric mean of the last growths, since pairs of eigenvalues make them swing. 0 where it cannot be found. */
static double fastest_rate(ali3_instance *in) {
  const int32_t nq = in->system->size.nq;
  double *x = in->step.stage, *v = x + nq, *a0 = v + nq, *a = a0 + nq, growth = 1.0;
  for (int32_t i = 0; i < nq; i++) {
    x[i] = 1.0 + 0.23 * (double)(i % 5); /* along no symmetry of the model */
    v[i] = 1.0 + 0.37 * (double)(i % 7);
  }
  if (!accelerations(in, x, v, 0.0, a0)) return 0.0;
  const double size = fmax(1.0, fmax(length(in->now.q, nq), length(in->now.qd, nq)));
  for (int round = 0; round < ROUNDS; round++) {
    const double scale = SHIFT * size / fmax(length(x, nq), length(v, nq));
    if (!(scale < 1e300) || !accelerations(in, x, v, scale, a)) return 0.0;
    const double before = length(v, nq);
    for (int32_t i = 0; i < nq; i++) {
      x[i] = v[i];
      v[i] = (a[i] - a0[i]) / scale;
    }
    const double ratio = length(v, nq) / before;
    if (!(ratio > 0.0 && ratio < 1e300)) return 0.0;
    if (round >= ROUNDS - COUNTED) growth *= sqrt(sqrt(sqrt(ratio)));
  }
  return growth;
}

/* The status of a step h of an explicit method that was refused, or ALI3_TOO_STIFF where that is the reason: the rate
 * says so, also of stages that ran away, or steps before this one have left a state without a rate. */
ali3_status ali3_explain_refusal(ali3_instance *in, ali3_status status, double h) {
  const double stable_rate = ali3_method_of(in)->stable_rate;
  const bool ran_away = status == ALI3_SINGULAR || status == ALI3_NOT_FINITE;
  if (stable_rate == 0.0) return status;
  if (!ran_away && status != ALI3_NOT_CONVERGED && status != ALI3_UNRESOLVED) return status;
  const ali3_report report = in->report;
  const double rate = fastest_rate(in), limit = ran_away ? RESOLVED : stable_rate;
  in->report = report;
  if (!(h * rate > limit || (ran_away && rate == 0.0 && report.steps > 0))) return status;
  in->report.fastest_rate = rate;
  in->report.last_status = ALI3_TOO_STIFF;
  return ALI3_TOO_STIFF;
}
