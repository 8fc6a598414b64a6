/* Messages: categories, what a host asked to hear, and calls out of order. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "slave.h"

static const char *const category_name[] = {"logStatusWarning", "logStatusDiscard", "logStatusError", "logStatusFatal",
                                            "logAll"};
enum { CATEGORIES = sizeof category_name / sizeof *category_name };

static int category_of(slave_status status) { return status == SLAVE_OK ? CATEGORIES - 1 : (int)status - 1; }

/* Problems are always logged, other messages on request; a host that named categories gets those. */
static bool wanted(const slave *s, slave_status status) {
  const unsigned bit = 1u << category_of(status);
  if (s->all_categories) return s->logging || status != SLAVE_OK;
  return (s->categories & (bit | SLAVE_LOG_ALL)) != 0;
}

slave_status slave_say(slave *s, slave_status status, const char *format, ...) {
  char text[SLAVE_TEXT];
  va_list list;
  if (s->logger == NULL || !wanted(s, status)) return status;
  va_start(list, format);
  vsnprintf(text, sizeof text, format, list);
  va_end(list);
  s->logger(s, status, category_name[category_of(status)], text);
  return status;
}

slave_status slave_set_logging(slave *s, bool on, size_t n, const char *const *categories) {
  unsigned chosen = 0;
  if (n > 0 && categories == NULL) return slave_say(s, SLAVE_ERROR, "The list of log categories is missing.");
  for (size_t i = 0; i < n; i++) {
    int k = 0;
    while (k < CATEGORIES && (categories[i] == NULL || strcmp(categories[i], category_name[k]) != 0)) k++;
    if (k == CATEGORIES)
      return slave_say(s, SLAVE_ERROR, "There is no log category '%.64s'; see modelDescription.xml for their names.",
                       categories[i] != NULL ? categories[i] : "");
    chosen |= 1u << k;
  }
  s->logging = on;
  s->all_categories = n == 0 || !on;
  s->categories = on ? chosen : 0;
  return SLAVE_OK;
}

const char *slave_phase_name(slave_phase phase) {
  switch (phase) {
  case SLAVE_INSTANTIATED:
    return "before initialisation";
  case SLAVE_INITIALISING:
    return "in initialisation";
  case SLAVE_STEPPING:
    return "after initialisation";
  case SLAVE_STEP_FAILED:
    return "after a refused step";
  default:
    return "after termination";
  }
}

bool slave_allowed(slave *s, const char *function, unsigned mask) {
  if (s->calls.phase & mask) return true;
  slave_say(s, SLAVE_ERROR, "%s is not allowed %s.", function, slave_phase_name(s->calls.phase));
  return false;
}
