/* Outputs that the System at work leaves out, such as the stresses of a rigid frame: computed when they are read, by the
 * same model with ports, which takes over the state and gives nothing back. */
#include "slave.h"

static int32_t follower_of(const slave *s) { return slave_the_table.follower[s->fidelity.number]; }

/* Whether the System at work does not compute it. */
bool slave_left_out(const slave *s, const slave_variable *v) { return v->uncomputed >> s->fidelity.number & 1; }

static bool load(slave *s) {
  const size_t number = (size_t)follower_of(s);
  if (s->follower.kernel != NULL && s->follower.number == number) return true;
  slave_fidelity_free(s, &s->follower);
  return slave_fidelity_load(s, number, &s->follower);
}

/* The values at the present state, once after each change of it; false, and said, where they cannot be found. The other
 * outputs are fresh. Without a follower they stay what the System at work gives. */
bool slave_follow(slave *s) {
  const slave_table *t = &slave_the_table;
  if (s->followed || follower_of(s) < 0) return true;
  if (!load(s)) return false;
  ali3_status status = ali3_ports_follow(s->follower.kernel, s->fidelity.kernel);
  if (status == ALI3_OK) status = ali3_sensors(s->follower.kernel, s->sensors);
  if (status != ALI3_OK) {
    slave_say(s, SLAVE_ERROR, "The forces at the ports could not be found: %s.", ali3_status_text(status));
    return false;
  }
  for (size_t i = t->n_known; i < t->n_variables; i++)
    if (slave_left_out(s, &t->variable[i])) s->value[i] = t->variable[i].scale * s->sensors[t->variable[i].index];
  s->followed = true;
  return true;
}
