/* The intermediate update of FMI 3.0: before each inner step of a communication step the host may set the inputs at its
 * end. The inputs at the ends of all inner steps are stored, linear in between, for the second motion, derivatives and
 * saved states. */
#include <math.h>
#include <string.h>

#include "slave.h"

/* Number of inputs of the kernel. */
static size_t input_count(const slave *s) { return (size_t)ali3_system_sizes(s->fidelity.system).nu; }

void slave_intermediate_free(slave *s) {
  if (s->intermediate.row != NULL) s->memory.release(s->intermediate.row);
  s->intermediate.row = NULL;
  s->intermediate.n = s->intermediate.capacity = 0;
}

bool slave_intermediate_reserve(slave *s, int64_t n) {
  const size_t nu = input_count(s), n_known = slave_the_table.n_known;
  if (s->intermediate.row != NULL && n <= s->intermediate.capacity) return true;
  double *row = s->memory.allocate(1, ((size_t)(n + 1) * nu + n_known) * sizeof(double) + n_known + 1);
  if (row == NULL) return false;
  const slave_intermediate old = s->intermediate;
  if (old.n > 0) memcpy(row, old.row, (size_t)(old.n + 1) * nu * sizeof(double));
  slave_intermediate_free(s);
  s->intermediate.n = old.n;
  s->intermediate.row = row;
  s->intermediate.value = row + (size_t)(n + 1) * nu;
  s->intermediate.was_set = (unsigned char *)(s->intermediate.value + n_known);
  s->intermediate.capacity = n;
  return true;
}

slave_status slave_set_intermediate(slave *s, const uint32_t *reference, size_t n, const double *value) {
  const slave_table *t = &slave_the_table;
  slave_status worst = SLAVE_OK;
  for (size_t i = 0; i < n; i++) {
    const bool input = reference[i] < t->n_known && t->variable[reference[i]].source == SLAVE_INPUT;
    if (!input || t->variable[reference[i]].whole)
      return slave_log(s, SLAVE_ERROR,
                       "Value reference %u was set within a step; real inputs can be, which have intermediateUpdate.",
                       (unsigned)reference[i]);
  }
  for (size_t i = 0; i < n; i++) {
    const slave_variable *v = &t->variable[reference[i]];
    double clamped;
    const slave_status status = slave_clamp(s, reference[i], value[i], &clamped);
    if (status > SLAVE_WARNING) return status;
    if (status > worst) worst = status;
    if (!(fabs(value[i]) < HUGE_VAL) && s->intermediate.was_set[reference[i]])
      continue; /* a port keeps its last value */
    s->intermediate.was_set[reference[i]] = 1;
    s->intermediate.value[reference[i]] = clamped;
    s->intermediate.next[v->index] = clamped / v->scale;
  }
  return worst;
}

/* Whether the vehicle has rolled over since the last inner step; then the step returns early if the host allows it. */
static bool turned_over(slave *s) {
  const bool before = s->overturned_warned;
  s->outputs = SLAVE_STALE;
  return slave_compute_outputs(s) && s->overturned_warned && !before;
}

ali3_status slave_intermediate_steps(slave *s, int64_t *n, double h, double *largest_residual) {
  const size_t nu = input_count(s), n_known = slave_the_table.n_known;
  ali3_instance *kernel = s->fidelity.kernel;
  const double begin = ali3_time(kernel);
  bool any_set = false;
  if (!slave_intermediate_reserve(s, *n)) return ALI3_NO_MEMORY;
  memset(s->intermediate.was_set, 0, n_known);
  slave_inputs_at(s, 0.0, s->intermediate.row);
  for (int64_t k = 0; k < *n; k++) {
    double *const last = s->intermediate.row + (size_t)k * nu;
    s->intermediate.next = last + nu;
    slave_inputs_at(s, (double)(k + 1) * h, s->intermediate.next);
    for (size_t i = 0; i < n_known; i++)
      if (s->intermediate.was_set[i])
        s->intermediate.next[slave_the_table.variable[i].index] = last[slave_the_table.variable[i].index];
    if (s->request_inputs != NULL) s->request_inputs(s, begin + (double)(k + 1) * h);
    const ali3_status status = ali3_run(kernel, h, 1, s->intermediate.next, 1, NULL, NULL, NULL);
    if (status != ALI3_OK && !(s->early_return && k > 0)) return status;
    if (status == ALI3_OK) *largest_residual = fmax(*largest_residual, ali3_capped_residual(kernel));
    if (status == ALI3_OK && !(s->early_return && turned_over(s))) continue;
    *n = status == ALI3_OK ? k + 1 : k;
    s->returned_early = true;
  }
  for (size_t i = 0; i < n_known; i++) any_set = any_set || s->intermediate.was_set[i];
  s->intermediate.n = any_set ? *n : 0;
  return ALI3_OK;
}

void slave_intermediate_accept(slave *s) {
  for (size_t i = 0; i < slave_the_table.n_known && s->intermediate.n > 0; i++) {
    if (!s->intermediate.was_set[i]) continue;
    s->value[i] = s->intermediate.value[i];
    memset(s->slope + i * SLAVE_TERMS, 0, SLAVE_TERMS * sizeof(double));
    memset(s->completed_slope + i * SLAVE_TERMS, 0, SLAVE_TERMS * sizeof(double));
  }
}
