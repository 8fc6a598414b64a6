/* Outputs that the System at work leaves out, such as the stresses of a rigid frame: computed when they are read, by the
 * same model with ports, which takes over the state and gives nothing back. */
#include "slave.h"

static int32_t follower_of(const slave *s) { return slave_the_table.follower[s->fidelity.number]; }

/* Whether the System at work does not compute it. */
bool slave_left_out(const slave *s, const slave_variable *v) { return v->uncomputed >> s->fidelity.number & 1; }

bool slave_has_follower(const slave *s) { return follower_of(s) >= 0; }

static bool load(slave *s) {
  const size_t number = (size_t)follower_of(s);
  if (s->follower.kernel != NULL && s->follower.number == number) return true;
  slave_fidelity_free(s, &s->follower);
  return slave_fidelity_load(s, number, &s->follower);
}

/* Those of the outputs that are left out, at the present state; false, and said, where they cannot be found. NULL: of all
 * outputs. The other outputs are fresh. Without a follower they stay what the System at work gives. */
bool slave_follow(slave *s, const uint32_t *reference, size_t n) {
  const slave_table *t = &slave_the_table;
  if (!slave_has_follower(s)) return true;
  if (!load(s)) return false;
  ali3_status status = s->followed ? ALI3_OK : ali3_ports_follow(s->follower.kernel, s->fidelity.kernel);
  if (status != ALI3_OK) {
    slave_say(s, SLAVE_ERROR, "The forces at the ports could not be found: %s.", ali3_status_text(status));
    return false;
  }
  s->followed = true;
  size_t wanted = 0;
  for (size_t k = 0; k < (reference != NULL ? n : t->n_variables - t->n_known); k++) {
    const uint32_t i = reference != NULL ? reference[k] : (uint32_t)(t->n_known + k);
    if (slave_left_out(s, &t->variable[i])) slave_will_read(s, &wanted, i);
  }
  return slave_read_sensors(s, s->follower.kernel, wanted);
}
