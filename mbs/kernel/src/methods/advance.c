/* A step by the method of the settings, in halves where it does not converge. What a method leaves as it is, switches
 * among it, it finds in in->next. */
#include "../instance.h"
#include "../state/books.h"
#include "../state/inputs.h"
#include "../state/vectors.h"
#include "check_method.h"
#include "energy_momentum.h"
#include "steps.h"

static ali3_status by_method(ali3_instance *in, double t, double h) {
  const int32_t method = in->settings.method;
  const ali3_status inputs = ali3_inputs_begin(in, t, h);
  if (inputs != ALI3_OK) return inputs;
  if (ali3_relative(in)) return ali3_semi_recursive(in, t, h); /* fills in->next only when somebody looks */
  if (method == ALI3_METHOD_ENERGY_MOMENTUM) ali3_energy_momentum_restart(in, h);
  if (method == ALI3_METHOD_ENERGY_MOMENTUM_4) ali3_energy_momentum_restart(in, ali3_composed(h));
  ali3_vectors_copy(in, &in->next, &in->now);
  switch (method) {
  case ALI3_METHOD_ENERGY_MOMENTUM:
    return ali3_energy_momentum(in, t, h, 0.5, !in->quiet);
  case ALI3_METHOD_ENERGY_MOMENTUM_4:
    return ali3_composition(in, t, h);
  case ALI3_METHOD_RUNGE_KUTTA_8:
    return ali3_runge_kutta(in, t, h);
  case ALI3_METHOD_RADAU_5:
    return ali3_radau(in, t, h);
  default:
    return ali3_augmented_lagrangian(in, t, h);
  }
}

/* A step to time t, in halves where it does not converge. */
ali3_status ali3_advance(ali3_instance *in, double t, double h, int32_t depth) {
  in->halves_left = depth > 0 && depth < in->settings.max_halvings;
  const ali3_status status = by_method(in, t, h);
  if (status == ALI3_OK) in->t_now = t;
  if (status == ALI3_OK && !ali3_relative(in)) ali3_books_step(in, h);
  if (status == ALI3_OK || status == ALI3_BAD_ARGUMENT || depth <= 0) return status;
  in->report.halvings++;
  ali3_keep(in);
  const ali3_status first = ali3_advance(in, t - 0.5 * h, 0.5 * h, depth - 1);
  return first == ALI3_OK ? ali3_advance(in, t, 0.5 * h, depth - 1) : first;
}
