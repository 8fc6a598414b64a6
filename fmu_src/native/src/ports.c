/* Warns of ports that the host has not set before the first step, or no longer sets: FMI holds their last values. */
#include <math.h>

#include "slave.h"

enum { MIN_TIMES_SET = 10 }; /* times that a port must have been set before its absence is reported */
static const double MIN_PAUSE = 0.5; /* s beyond the longest interval between two of these times */

/* Records when a port was set to a finite number, and when its value changed. */
void slave_record_port_set(slave *s, size_t i, bool changed) {
  slave_rhythm *r = &s->rhythm[i];
  if (!slave_the_table.variable[i].port) return;
  const double now = s->calls.initialised ? ali3_time(s->fidelity.kernel) : s->calls.start_time;
  if (r->times == 0.0 || now > r->given) {
    if (r->times > 0.0) r->longest = fmax(r->longest, now - r->given);
    r->times = fmin(r->times + 1.0, MIN_TIMES_SET);
    r->given = now;
  }
  if (!changed || !(now > r->changed)) return;
  const double span = now - r->changed;
  r->held = fmin(r->span, span); /* the shorter of the last two intervals: a single long one does not count */
  r->span = span;
  r->changed = now;
}

static void say_first(slave *s, const slave_variable *first, size_t silent) {
  const double held = s->value[first - slave_the_table.variable];
  if (silent == 1)
    slave_say(s, SLAVE_WARNING,
              "The port '%s' was not set before the first step and holds %g%s until it is. This is reported once.",
              first->name, held, first->unit);
  else
    slave_say(s, SLAVE_WARNING,
              "%zu ports were not set before the first step. Each holds its start value until it is set, as '%s' holds "
              "%g%s. This is reported once.",
              silent, first->name, held, first->unit);
}

static void say_stopped(slave *s, const slave_variable *first, size_t silent) {
  const ptrdiff_t i = first - slave_the_table.variable;
  const double given = s->rhythm[i].given, held = s->value[i];
  if (silent == 1)
    slave_say(s, SLAVE_WARNING,
              "The port '%s' was given a number again and again until %.6g s and none since; it holds %g%s. This is "
              "reported once.",
              first->name, given, held, first->unit);
  else
    slave_say(s, SLAVE_WARNING,
              "%zu ports were given numbers again and again and get none any more, '%s' since %.6g s. Each holds its "
              "last one, as '%s' holds %g%s. This is reported once.",
              silent, first->name, given, first->name, held, first->unit);
}

/* Logs the warnings after a step that began at `begin`. Ports of whole numbers may cease to be set, as they change at
 * events only. A warning does not change the status of the step. */
void slave_watch_ports(slave *s, double begin) {
  const slave_table *t = &slave_the_table;
  const slave_variable *first = NULL, *stopped = NULL;
  size_t silent = 0, stops = 0;
  for (size_t i = 0; i < t->n_known; i++) {
    const slave_rhythm *r = &s->rhythm[i];
    if (!t->variable[i].port) continue;
    if (!(s->said[i] & SLAVE_GIVEN)) {
      s->said[i] |= SLAVE_GIVEN;
      if (silent++ == 0) first = &t->variable[i];
    } else if (!t->variable[i].whole && r->times >= MIN_TIMES_SET && begin - r->given > MIN_PAUSE + r->longest) {
      s->rhythm[i].times = -HUGE_VAL; /* the warning is logged once */
      if (stops++ == 0) stopped = &t->variable[i];
    }
  }
  if (first != NULL) say_first(s, first, silent);
  if (stopped != NULL) say_stopped(s, stopped, stops);
}
