/* Cause of a refused step of an explicit method: the fastest rate of the motion against the step. */
#include <math.h>
#include <string.h>

#include "../instance.h"
#include "../method.h"
#include "../start/index_one.h"
#include "../state/vectors.h"
#include "stiffness.h"

enum { ITERATIONS = 24, AVERAGED = 8 }; /* the eighth root is three square roots */
static const double SHIFT = 1e-7; /* relative to the size of the state, at least 1 */
static const double RESOLVED = 1.0; /* step times rate at which stages do not diverge */

static double norm(const double *x, int32_t n) {
  double sum = 0.0;
  for (int32_t i = 0; i < n; i++) sum += x[i] * x[i];
  return sqrt(sum);
}

/* Accelerations out (nq) at in->now plus scale (x, v); overwrites in->next. */
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

/* Largest absolute eigenvalue of the equations of index one at in->now, 1/s, by power iteration with difference
 * quotients; the geometric mean of the last growth factors, as they oscillate for pairs of eigenvalues. 0: not
 * found. */
static double fastest_rate(ali3_instance *in) {
  const int32_t nq = in->system->size.nq;
  double *x = in->step.stage, *v = x + nq, *a0 = v + nq, *a = a0 + nq, mean_growth = 1.0;
  for (int32_t i = 0; i < nq; i++) {
    x[i] = 1.0 + 0.23 * (double)(i % 5); /* not along a symmetry of the model */
    v[i] = 1.0 + 0.37 * (double)(i % 7);
  }
  if (!accelerations(in, x, v, 0.0, a0)) return 0.0;
  const double size = fmax(1.0, fmax(norm(in->now.q, nq), norm(in->now.qd, nq)));
  for (int iteration = 0; iteration < ITERATIONS; iteration++) {
    const double scale = SHIFT * size / fmax(norm(x, nq), norm(v, nq));
    if (!(scale < 1e300) || !accelerations(in, x, v, scale, a)) return 0.0;
    const double before = norm(v, nq);
    for (int32_t i = 0; i < nq; i++) {
      x[i] = v[i];
      v[i] = (a[i] - a0[i]) / scale;
    }
    const double ratio = norm(v, nq) / before;
    if (!(ratio > 0.0 && ratio < 1e300)) return 0.0;
    if (iteration >= ITERATIONS - AVERAGED) mean_growth *= sqrt(sqrt(sqrt(ratio)));
  }
  return mean_growth;
}

ali3_status ali3_explain_refusal(ali3_instance *in, ali3_status status, double h) {
  const double stable_rate = ali3_method_of(in)->stable_rate;
  const bool diverged = status == ALI3_SINGULAR || status == ALI3_NOT_FINITE;
  if (stable_rate == 0.0) return status;
  if (!diverged && status != ALI3_NOT_CONVERGED && status != ALI3_UNRESOLVED) return status;
  const ali3_report report = in->report;
  const double rate = fastest_rate(in), limit = diverged ? RESOLVED : stable_rate;
  in->report = report;
  if (!(h * rate > limit || (diverged && rate == 0.0 && report.steps > 0))) return status;
  in->report.fastest_rate = rate;
  in->report.last_status = ALI3_TOO_STIFF;
  return ALI3_TOO_STIFF;
}
