/* Outputs that are sensors: only those that are read are evaluated, once for each state. */
#include "slave.h"

void slave_request_sensor(slave *s, size_t *n, uint32_t reference) {
  if (s->fresh[reference]) return;
  s->fresh[reference] = 1;
  s->sensor[*n] = slave_the_table.variable[reference].index;
  s->output[(*n)++] = reference;
}

bool slave_read_sensors(slave *s, ali3_instance *kernel, size_t n) {
  if (ali3_some_sensors(kernel, (int32_t)n, s->sensor, s->sensors) != ALI3_OK) {
    for (size_t k = 0; k < n; k++) s->fresh[s->output[k]] = 0;
    return false;
  }
  for (size_t k = 0; k < n; k++) s->value[s->output[k]] = slave_the_table.variable[s->output[k]].scale * s->sensors[k];
  return true;
}
