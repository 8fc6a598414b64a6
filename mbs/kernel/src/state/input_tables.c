/* Inputs from tables over time, piecewise linear with jumps. */
#include <math.h>
#include <stdbool.h>

#include "../../include/ali3.h"

/* Number of times below t, with `or_at` also those at t. */
static int64_t count_times(const ali3_input_table *x, double t, bool or_at) {
  int64_t low = 0, high = x->n;
  while (low < high) {
    const int64_t middle = low + (high - low) / 2;
    if (or_at ? x->time[middle] <= t : x->time[middle] < t)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

int32_t ali3_input_of_tables(void *tables, double t, int32_t after, double *input) {
  const ali3_input_tables *set = tables;
  for (int32_t i = 0; i < set->n; i++) {
    const ali3_input_table *x = &set->table[i];
    const int64_t next = after ? count_times(x, t + set->tolerance, true) : count_times(x, t - set->tolerance, false);
    if (next == 0 || next == x->n) {
      input[x->input] = x->value[next == 0 ? 0 : x->n - 1];
      continue;
    }
    const double *time = x->time + next - 1, *value = x->value + next - 1, span = time[1] - time[0];
    const double fraction = span > 0.0 ? (t - time[0]) / span : 0.0;
    input[x->input] = value[0] + fmax(0.0, fmin(1.0, fraction)) * (value[1] - value[0]);
  }
  return 0;
}
