/* Kinks in a communication step: elements that pass to another smooth piece of their law in it, as at a stop that is met
 * or where friction begins to slip. There a derivative depends on where within an inner step that is. */
#include <stdio.h>
#include <string.h>

#include "slave.h"

/* `beside`: the replay before, of other inputs, has the same pieces where no kink lies between both. */
void slave_kinks_begin(slave_kinks *k, ali3_instance *kernel, bool beside) {
  uint32_t *const other = k->begin;
  k->begin = k->other;
  k->other = other;
  ali3_law_pieces(kernel, k->begin);
  for (int32_t e = 0; e < k->ne && beside; e++) k->passed[e] |= k->begin[e] != k->other[e];
}

void slave_kinks_after(slave_kinks *k, ali3_instance *kernel) {
  ali3_law_pieces(kernel, k->now);
  for (int32_t e = 0; e < k->ne; e++) k->passed[e] |= k->now[e] != k->begin[e];
}

/* The first element that passes by its name, the others by their count. */
slave_status slave_kinks_say(slave *s, const slave_kinks *k) {
  const slave_table *t = &slave_the_table;
  const char *const *name = t->element + t->first_element[s->fidelity.number], *first = NULL;
  char more[SLAVE_TEXT / 8] = "";
  size_t count = 0;
  for (int32_t e = 0; e < k->ne; e++)
    if (k->passed[e] && count++ == 0) first = name[e];
  if (count == 0) return SLAVE_OK;
  if (count > 1) snprintf(more, sizeof more, " (as do %zu more elements)", count - 1);
  return slave_say(s, SLAVE_ERROR,
                   "There is no directional derivative of this communication step: in it '%.128s' passes a kink of its "
                   "law%s: a stop is met or left, friction sticks or slips, or a limit is reached.",
                   first, more);
}
