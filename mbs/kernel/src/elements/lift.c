/* Aerodynamic lift F = rho A v^2 / 2 up, N, at a point of a body in still air, along its upward axis `up`; v is the
 * velocity of the point along the forward axis; earth axes. With integers, see moving_air.h, v is relative to moving
 * air. */
#include "../algebra/small_vectors.h"
#include "element.h"
#include "lift_fields.h"
#include "moving_air.h"

static void evaluate(ali3_element_args *a) {
  const int32_t n = a->nsig / 3;
  double relative[3];
  const double *velocity = a->nint > 0 ? relative : a->ud, *forward = a->u + n, *up = a->u + 2 * n;
  if (a->nint > 0) ali3_relative_to_air(a->input, a->integer, a->ud, relative);
  const double factor = 0.5 * a->real[AIR_DENSITY] * a->real[LIFT_AREA];
  double v = 0.0;
  for (int32_t i = 0; i < n; i++) v += velocity[i] * forward[i];
  for (int32_t i = 0; i < n; i++) a->f[i] = factor * v * v * up[i];
  a->out[LIFT_OUT_FORCE] = factor * v * v;
  a->potential = 0.0;
  if (!a->S) return;
  /* symmetric part of -df/d(point rate), -df/d(axes) */
  for (int32_t i = 0; i < n; i++) {
    for (int32_t j = 0; j < n; j++) {
      const double by_rate = -a->wC * factor * v * up[i] * forward[j];
      a->S[i * a->nsig + j] += by_rate;
      a->S[j * a->nsig + i] += by_rate;
      const double by_forward = -a->wK * factor * v * up[i] * velocity[j];
      a->S[i * a->nsig + n + j] += by_forward;
      a->S[(n + j) * a->nsig + i] += by_forward;
    }
    const double by_up = -0.5 * a->wK * factor * v * v;
    a->S[i * a->nsig + 2 * n + i] += by_up;
    a->S[(2 * n + i) * a->nsig + i] += by_up;
  }
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint) {
  (void)real, (void)nreal, (void)integer;
  return nint != 0 && (nint != AIR_INPUTS || nsig != 9) ? "lift in moving air needs space and two inputs" : 0;
}

const ali3_element_type ali3_lift = {
    ALI3_LIFT,
    .evaluate = evaluate,
    .check = check,
};
