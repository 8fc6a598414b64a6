/* Outputs that are sensors, evaluated when they are read, those alone, and once for a state. */
#include "slave.h"

/* Puts a sensor that is not fresh on the list of *n that are evaluated. */
void slave_will_read(slave *s, size_t *n, uint32_t reference) {
  if (s->fresh[reference]) return;
  s->fresh[reference] = 1;
  s->number[*n] = slave_the_table.variable[reference].index;
  s->place[(*n)++] = reference;
}

/* Evaluates those of the list; they are not fresh where this fails. */
bool slave_read_sensors(slave *s, ali3_instance *kernel, size_t n) {
  if (ali3_some_sensors(kernel, (int32_t)n, s->number, s->sensors) != ALI3_OK) {
    for (size_t k = 0; k < n; k++) s->fresh[s->place[k]] = 0;
    return false;
  }
  for (size_t k = 0; k < n; k++) s->value[s->place[k]] = slave_the_table.variable[s->place[k]].scale * s->sensors[k];
  return true;
}
