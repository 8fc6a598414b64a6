/* The intermediate update of FMI 3.0: before each inner step of a communication step the host may give the inputs at its
 * end. Inputs at the ends of all inner steps are kept, linear in between: the second motion, derivatives and saved states
 * need them. */
#include <math.h>
#include <string.h>

#include "slave.h"

static size_t inputs_of(const slave *s) { return (size_t)ali3_system_sizes(s->fidelity.system).nu; }

void slave_asked_free(slave *s) {
  if (s->asked.row != NULL) s->memory.release(s->asked.row);
  s->asked.row = NULL;
  s->asked.n = s->asked.room = 0;
}

/* Room for rows of n inner steps and their start, and what was given of each variable. */
bool slave_asked_room(slave *s, int64_t n) {
  const size_t nu = inputs_of(s), n_known = slave_the_table.n_known;
  if (s->asked.row != NULL && n <= s->asked.room) return true;
  double *row = s->memory.allocate(1, ((size_t)(n + 1) * nu + n_known) * sizeof(double) + n_known + 1);
  if (row == NULL) return false;
  const slave_asked old = s->asked;
  if (old.n > 0) memcpy(row, old.row, (size_t)(old.n + 1) * nu * sizeof(double));
  slave_asked_free(s);
  s->asked.n = old.n;
  s->asked.row = row;
  s->asked.value = row + (size_t)(n + 1) * nu;
  s->asked.given = (unsigned char *)(s->asked.value + n_known);
  s->asked.room = n;
  return true;
}

slave_status slave_set_asked(slave *s, const uint32_t *reference, size_t n, const double *value) {
  const slave_table *t = &slave_the_table;
  slave_status worst = SLAVE_OK;
  for (size_t i = 0; i < n; i++) {
    const bool input = reference[i] < t->n_known && t->variable[reference[i]].source == SLAVE_INPUT;
    if (!input || t->variable[reference[i]].whole)
      return slave_say(s, SLAVE_ERROR,
                       "Value reference %u was set within a step; real inputs can be, which have intermediateUpdate.",
                       (unsigned)reference[i]);
  }
  for (size_t i = 0; i < n; i++) {
    const slave_variable *v = &t->variable[reference[i]];
    double taken;
    const slave_status status = slave_taken(s, reference[i], value[i], &taken);
    if (status > SLAVE_WARNING) return status;
    if (status > worst) worst = status;
    if (!(fabs(value[i]) < HUGE_VAL) && s->asked.given[reference[i]]) continue; /* a port holds its last value */
    s->asked.given[reference[i]] = 1;
    s->asked.value[reference[i]] = taken;
    s->asked.next[v->index] = taken / v->scale;
  }
  return worst;
}

/* Whether the car has turned over since the last inner step, which ends a step early where the host allows it. */
static bool turned_over(slave *s) {
  const bool before = s->overturned_said;
  s->outputs = SLAVE_STALE;
  return slave_outputs(s) && s->overturned_said && !before;
}

/* Makes up to *n inner steps of h; *n becomes their number if the step ends early. */
ali3_status slave_asked_steps(slave *s, int64_t *n, double h, double *left) {
  const size_t nu = inputs_of(s), n_known = slave_the_table.n_known;
  ali3_instance *kernel = s->fidelity.kernel;
  const double begin = ali3_time(kernel);
  bool any = false;
  if (!slave_asked_room(s, *n)) return ALI3_NO_MEMORY;
  memset(s->asked.given, 0, n_known);
  slave_inputs_at(s, 0.0, s->asked.row);
  for (int64_t k = 0; k < *n; k++) {
    double *const last = s->asked.row + (size_t)k * nu;
    s->asked.next = last + nu;
    slave_inputs_at(s, (double)(k + 1) * h, s->asked.next);
    for (size_t i = 0; i < n_known; i++)
      if (s->asked.given[i]) s->asked.next[slave_the_table.variable[i].index] = last[slave_the_table.variable[i].index];
    if (s->ask != NULL) s->ask(s, begin + (double)(k + 1) * h);
    const ali3_status status = ali3_run(kernel, h, 1, s->asked.next, 1, NULL, NULL, NULL);
    if (status != ALI3_OK && !(s->early && k > 0)) return status;
    if (status == ALI3_OK) *left = fmax(*left, ali3_capped_residual(kernel));
    if (status == ALI3_OK && !(s->early && turned_over(s))) continue;
    *n = status == ALI3_OK ? k + 1 : k;
    s->returned_early = true;
  }
  for (size_t i = 0; i < n_known; i++) any = any || s->asked.given[i];
  s->asked.n = any ? *n : 0;
  return ALI3_OK;
}

/* After a good step inputs that the host gave within it keep their last value; their slopes are zero. */
void slave_asked_taken(slave *s) {
  for (size_t i = 0; i < slave_the_table.n_known && s->asked.n > 0; i++) {
    if (!s->asked.given[i]) continue;
    s->value[i] = s->asked.value[i];
    memset(s->slope + i * SLAVE_TERMS, 0, SLAVE_TERMS * sizeof(double));
    memset(s->made_slope + i * SLAVE_TERMS, 0, SLAVE_TERMS * sizeof(double));
  }
}
