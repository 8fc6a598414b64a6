/* Aerodynamic drag F = -rho CdA |w| w / 2, N, at a point with the velocity w relative to the moving air; earth axes. */
#include "../algebra/small_vectors.h"
#include "element.h"
#include "moving_air.h"
#include "wind_drag_fields.h"

static void evaluate(ali3_element_args *a) {
  const double factor = 0.5 * a->real[AIR_DENSITY] * a->real[DRAG_AREA];
  double w[3];
  ali3_relative_to_air(a->input, a->integer, a->ud, w);
  const double speed = ali3_norm(w);
  for (int i = 0; i < 3; i++) a->f[i] = -factor * speed * w[i];
  a->out[WIND_DRAG_OUT_FORCE] = factor * speed * speed;
  a->potential = 0.0;
  if (!a->S) return;
  for (int i = 0; i < 3; i++) a->S[i * 3 + i] = a->wC * factor * speed;
  if (speed > 0.0) ali3_add_outer(a->S, 3, a->wC * factor / speed, w);
}

const ali3_element_type ali3_wind_drag = {
    ALI3_WIND_DRAG,
    .evaluate = evaluate,
};
