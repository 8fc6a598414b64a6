/* Inputs along their derivatives within a communication step. The term of order 0, which no host sets, is what an answer
 * on the road begins with beside its value, see road_ramps.c. */
#include <math.h>

#include "slave.h"

/* What derivatives change in the input of a variable at `elapsed` after the communication point. */
void slave_add_slope(const double *slope, size_t variable, double elapsed, double *input) {
  double power = 1.0;
  for (int k = 0; k < SLAVE_TERMS; k++) {
    *input += slope[variable * SLAVE_TERMS + (size_t)k] * power / slave_the_table.variable[variable].scale;
    power *= elapsed / (k + 1);
  }
}

/* The same in all inputs (nu). */
void slave_add_slopes(const double *slope, double elapsed, double *input) {
  const slave_table *t = &slave_the_table;
  for (size_t i = 0; i < t->n_known; i++)
    if (t->variable[i].source == SLAVE_INPUT) slave_add_slope(slope, i, elapsed, &input[t->variable[i].index]);
}

/* The inputs at `elapsed` after the communication point of the step that they are kept of; room for all. */
void slave_asked_at(const slave *s, double elapsed, double h, double *input) {
  const size_t nu = (size_t)ali3_system_sizes(s->fidelity.system).nu;
  const double at = fmin(fmax(elapsed / h, 0.0), (double)s->asked.n);
  const int64_t k = (int64_t)fmin(floor(at + 1e-9), (double)(s->asked.n - 1));
  const double share = at - (double)k;
  const double *from = s->asked.row + (size_t)k * nu, *to = from + nu;
  for (size_t i = 0; i < nu; i++) input[i] = share == 1.0 ? to[i] : from[i] + share * (to[i] - from[i]);
}

/* The inputs at `elapsed` after the communication point; the kernel holds them in their ranges. */
void slave_inputs_at(const slave *s, double elapsed, double *input) {
  const slave_table *t = &slave_the_table;
  if (s->asked.n > 0) {
    slave_asked_at(s, elapsed, s->made.h, input);
    return;
  }
  for (size_t i = 0; i < t->n_known; i++)
    if (t->variable[i].source == SLAVE_INPUT) input[t->variable[i].index] = s->value[i] / t->variable[i].scale;
  slave_add_slopes(s->slope, elapsed, input);
}
