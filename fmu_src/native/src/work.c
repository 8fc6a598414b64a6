/* Limit of work in one call of FMI, which cannot be cancelled: inner steps, parts of them and iterations are counted
 * together. */
#include <math.h>

#include "slave.h"

enum {
  STEP_WORK = 2,
  START_WORK = 20,
  SETTLING_WORK = STEP_WORK + ALI3_SETTLING_WORK
}; /* at least; START_WORK: as measured */
#define TEXT_OF(number) #number
#define TEXT_OF_VALUE(number) TEXT_OF(number)

void slave_reset_work(slave *s) { s->work_left = SLAVE_MAX_WORK; }

double slave_steps_left(const slave *s) { return floor((double)s->work_left / STEP_WORK); }

const slave_variable *slave_settling(const slave *s) {
  const slave_table *t = &slave_the_table;
  for (size_t i = 0; i < t->n_known; i++)
    if (t->variable[i].source == SLAVE_SETTLING && s->value[i] > 0.0) return &t->variable[i];
  return NULL;
}

double slave_settling_steps(const slave *s) {
  const slave_variable *v = slave_settling(s);
  return v != NULL ? ceil(s->value[v - slave_the_table.variable] / s->value[s->step_reference] * (1.0 - 1e-9)) : 0.0;
}

double slave_settling_left(const slave *s, double starts) {
  return floor(((double)s->work_left - starts * START_WORK) / (starts * SETTLING_WORK));
}

void slave_count_start(slave *s) { s->work_left -= START_WORK; }

const char *slave_reason_text(const slave *s, ali3_status status) {
  if (status != ALI3_TOO_MUCH_WORK || s->work_left > 0) return ali3_status_text(status);
  return "the call has made as many inner steps, parts of them and iterations as one may, " TEXT_OF_VALUE(
      SLAVE_MAX_WORK) " together";
}
