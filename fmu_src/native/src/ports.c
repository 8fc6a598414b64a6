/* Warns of ports that the host has not set before the first step, or has ceased to set: FMI holds their last values. */
#include <math.h>

#include "slave.h"

enum { MIN_TIMES_SET = 10 }; /* number of times that a port must have been set before a stop is reported */
static const double MIN_PAUSE = 0.5; /* s, beyond the longest interval between two of them */

void slave_record_port_set(slave *s, size_t i, bool changed) {
  slave_port_times *r = &s->port_times[i];
  if (!slave_the_table.variable[i].port) return;
  const double now = s->calls.initialised ? ali3_time(s->fidelity.kernel) : s->calls.start_time;
  if (r->times == 0.0 || now > r->last_set) {
    if (r->times > 0.0) r->longest = fmax(r->longest, now - r->last_set);
    r->times = fmin(r->times + 1.0, MIN_TIMES_SET);
    r->last_set = now;
  }
  if (!changed || !(now > r->changed)) return;
  const double span = now - r->changed;
  r->held = fmin(r->span, span); /* a single long interval does not count */
  r->span = span;
  r->changed = now;
}

/* first: the first of n_ports ports. */
static void warn_never_set(slave *s, const slave_variable *first, size_t n_ports) {
  const double held = s->value[first - slave_the_table.variable];
  if (n_ports == 1)
    slave_log(s, SLAVE_WARNING,
              "The port '%s' was not set before the first step and holds %g%s until it is. This is reported once.",
              first->name, held, first->unit);
  else
    slave_log(s, SLAVE_WARNING,
              "%zu ports were not set before the first step. Each holds its start value until it is set, as '%s' holds "
              "%g%s. This is reported once.",
              n_ports, first->name, held, first->unit);
}

/* Likewise. */
static void warn_stopped(slave *s, const slave_variable *first, size_t n_ports) {
  const ptrdiff_t i = first - slave_the_table.variable;
  const double last_set = s->port_times[i].last_set, held = s->value[i];
  if (n_ports == 1)
    slave_log(s, SLAVE_WARNING,
              "The port '%s' received numbers until %.6g s and none since; it holds %g%s. This is "
              "reported once.",
              first->name, last_set, held, first->unit);
  else
    slave_log(s, SLAVE_WARNING,
              "%zu ports received numbers and get none any more, '%s' since %.6g s. Each holds its "
              "last one, as '%s' holds %g%s. This is reported once.",
              n_ports, first->name, last_set, first->name, held, first->unit);
}

void slave_watch_ports(slave *s, double begin) {
  const slave_table *t = &slave_the_table;
  const slave_variable *first = NULL, *stopped = NULL;
  size_t n_ports = 0, stops = 0;
  for (size_t i = 0; i < t->n_known; i++) {
    const slave_port_times *r = &s->port_times[i];
    if (!t->variable[i].port) continue;
    if (!(s->input_flags[i] & SLAVE_WAS_SET)) {
      s->input_flags[i] |= SLAVE_WAS_SET;
      if (n_ports++ == 0) first = &t->variable[i];
    } else if (!t->variable[i].whole && r->times >= MIN_TIMES_SET && begin - r->last_set > MIN_PAUSE + r->longest) {
      s->port_times[i].times = -HUGE_VAL; /* reported */
      if (stops++ == 0) stopped = &t->variable[i];
    }
  }
  if (first != NULL) warn_never_set(s, first, n_ports);
  if (stopped != NULL) warn_stopped(s, stopped, stops);
}
