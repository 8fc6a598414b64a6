/* Inputs along their derivatives within a communication step. The term of order 0, which no host sets, is the initial
 * offset of an answer on the road from its value, see road_ramps.c. */
#include <math.h>

#include "slave.h"

void slave_add_slope(const double *slope, size_t variable, double elapsed, double *input) {
  double power = 1.0;
  for (int k = 0; k < SLAVE_TERMS; k++) {
    *input += slope[variable * SLAVE_TERMS + (size_t)k] * power / slave_the_table.variable[variable].scale;
    power *= elapsed / (k + 1);
  }
}

void slave_add_slopes(const double *slope, double elapsed, double *input) {
  const slave_table *t = &slave_the_table;
  for (size_t i = 0; i < t->n_known; i++)
    if (t->variable[i].source == SLAVE_INPUT) slave_add_slope(slope, i, elapsed, &input[t->variable[i].index]);
}

void slave_intermediate_at(const slave *s, double elapsed, double h, double *input) {
  const size_t nu = (size_t)ali3_system_sizes(s->fidelity.system).nu;
  const double position = fmin(fmax(elapsed / h, 0.0), (double)s->intermediate.n);
  const int64_t k = (int64_t)fmin(floor(position + 1e-9), (double)(s->intermediate.n - 1));
  const double fraction = position - (double)k;
  const double *from = s->intermediate.row + (size_t)k * nu, *to = from + nu;
  for (size_t i = 0; i < nu; i++) input[i] = fraction == 1.0 ? to[i] : from[i] + fraction * (to[i] - from[i]);
}

void slave_inputs_at(const slave *s, double elapsed, double *input) {
  const slave_table *t = &slave_the_table;
  if (s->intermediate.n > 0) {
    slave_intermediate_at(s, elapsed, s->completed.h, input);
    return;
  }
  for (size_t i = 0; i < t->n_known; i++)
    if (t->variable[i].source == SLAVE_INPUT) input[t->variable[i].index] = s->value[i] / t->variable[i].scale;
  slave_add_slopes(s->slope, elapsed, input);
}
