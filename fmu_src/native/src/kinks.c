/* Kinks in a communication step: elements that change between smooth pieces of their law, as at an end stop or where
 * friction starts to slip. There a derivative depends on the instant of the change within an inner step. */
#include <stdio.h>
#include <string.h>

#include "slave.h"

/* `beside`: compare with the start of the replay before, whose pieces differ if a kink lies between the inputs of
 * both. */
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

slave_status slave_kinks_report(slave *s, const slave_kinks *k) {
  const slave_table *t = &slave_the_table;
  const char *const *name = t->element + t->first_element[s->fidelity.number], *first = NULL;
  char others[SLAVE_TEXT / 8] = "";
  size_t count = 0;
  for (int32_t e = 0; e < k->ne; e++)
    if (k->passed[e] && count++ == 0) first = name[e];
  if (count == 0) return SLAVE_OK;
  if (count > 1) snprintf(others, sizeof others, " (as do %zu more elements)", count - 1);
  return slave_log(s, SLAVE_ERROR,
                   "There is no directional derivative of this communication step: in it '%.128s' passes a kink of its "
                   "law%s: a stop is met or left, friction sticks or slips, or a limit is reached.",
                   first, others);
}
