/* Inputs from tables over time, piecewise linear with jumps. */
#include <math.h>
#include <stdbool.h>

#include "../../include/ali3.h"

/* Number of times below `t`, or not above it. */
static int64_t count(const ali3_input_table *x, double t, bool or_at) {
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
  const ali3_input_tables *all = tables;
  for (int32_t i = 0; i < all->n; i++) {
    const ali3_input_table *x = &all->table[i];
    const int64_t right = after ? count(x, t + all->tolerance, true) : count(x, t - all->tolerance, false);
    if (right == 0 || right == x->n) {
      input[x->input] = x->value[right == 0 ? 0 : x->n - 1];
      continue;
    }
    const double *time = x->time + right - 1, *value = x->value + right - 1, span = time[1] - time[0];
    const double share = span > 0.0 ? (t - time[0]) / span : 0.0;
    input[x->input] = value[0] + fmax(0.0, fmin(1.0, share)) * (value[1] - value[0]);
  }
  return 0;
}
