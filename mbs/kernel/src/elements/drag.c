/* Aerodynamic drag F = -rho CdA |v| v / 2, N, at a point with the velocity v in still air; earth axes. */
#include "../algebra/small_vectors.h"
#include "drag_fields.h"
#include "element.h"

static void evaluate(ali3_element_args *a) {
  const int32_t n = a->nsig;
  const real factor = 0.5 * a->real[AIR_DENSITY] * a->real[DRAG_AREA];
  real square = {0};
  for (int32_t i = 0; i < n; i++) square += a->ud[i] * a->ud[i];
  const real speed = ali3_sqrt(square);
  for (int32_t i = 0; i < n; i++) a->f[i] = -factor * speed * a->ud[i];
  a->out[DRAG_OUT_FORCE] = factor * square;
  a->potential = ali3_same(0.0);
  if (!a->S) return;
  const lane_mask moves = speed > 0.0;
  for (int32_t i = 0; i < n; i++) a->S[i * n + i] = a->wC * factor * speed;
  if (ali3_any(moves)) ali3_add_outer(a->S, n, ali3_where(moves, a->wC * factor / speed, ali3_same(0.0)), a->ud);
}

#ifndef ALI3_WIDTH
const ali3_element_type ali3_drag = {
    ALI3_DRAG,
    .evaluate = evaluate,
};
#endif
