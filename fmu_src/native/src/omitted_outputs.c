/* Outputs that the loaded System omits, such as the stresses of a rigid frame: computed when they are read, by the
 * follower, a System of the same model with ports, which copies the state and has no effect on it. */
#include "slave.h"

/* Number of the System that computes the omitted outputs; -1: none. */
static int32_t follower_number(const slave *s) { return slave_the_table.follower[s->fidelity.number]; }

bool slave_is_omitted(const slave *s, const slave_variable *v) { return v->uncomputed >> s->fidelity.number & 1; }

bool slave_has_follower(const slave *s) { return follower_number(s) >= 0; }

/* Loads it unless it is loaded; false: an error was logged. */
static bool load_follower(slave *s) {
  const size_t number = (size_t)follower_number(s);
  if (s->follower.kernel != NULL && s->follower.number == number) return true;
  slave_fidelity_free(s, &s->follower);
  return slave_fidelity_load(s, number, &s->follower);
}

bool slave_omitted_outputs(slave *s, const uint32_t *reference, size_t n) {
  const slave_table *t = &slave_the_table;
  if (!slave_has_follower(s)) return true;
  if (!load_follower(s)) return false;
  ali3_status status = s->follower_current ? ALI3_OK : ali3_ports_follow(s->follower.kernel, s->fidelity.kernel);
  if (status != ALI3_OK) {
    slave_log(s, SLAVE_ERROR, "The forces at the ports could not be found: %s.", ali3_status_text(status));
    return false;
  }
  s->follower_current = true;
  size_t n_sensors = 0;
  for (size_t k = 0; k < (reference != NULL ? n : t->n_variables - t->n_known); k++) {
    const uint32_t i = reference != NULL ? reference[k] : (uint32_t)(t->n_known + k);
    if (slave_is_omitted(s, &t->variable[i])) slave_request_sensor(s, &n_sensors, i);
  }
  return slave_read_sensors(s, s->follower.kernel, n_sensors);
}
