/* What one call of FMI may cost, for none can be cancelled: inner steps, parts of them and iterations together. */
#include <math.h>

#include "slave.h"

enum { OF_STEP = 2, OF_START = 20, OF_SETTLING = OF_STEP + ALI3_SETTLING_WORK }; /* at least; starts as measured */
#define TEXT_OF(number) #number
#define IN_WORDS(number) TEXT_OF(number)

void slave_work_begins(slave *s) { s->work_left = SLAVE_MOST_WORK; }

double slave_steps_left(const slave *s) { return floor((double)s->work_left / OF_STEP); }

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
  return floor(((double)s->work_left - starts * OF_START) / (starts * OF_SETTLING));
}

void slave_work_of_start(slave *s) { s->work_left -= OF_START; }

const char *slave_reason(const slave *s, ali3_status status) {
  if (status != ALI3_TOO_DEAR || s->work_left > 0) return ali3_status_text(status);
  return "the call has made as many inner steps, parts of them and iterations as one may, " IN_WORDS(
      SLAVE_MOST_WORK) " together";
}
