/* Log messages: categories, selection by the host; checks of the order of calls. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "slave.h"

/* First the categories of the statuses, beginning with SLAVE_WARNING. */
static const char *const category_name[] = {"logStatusWarning", "logStatusDiscard", "logStatusError",
                                            "logStatusFatal",   "logNotComputed",   "logAll"};
enum { CATEGORIES = sizeof category_name / sizeof *category_name, ALL = CATEGORIES - 1, NOT_COMPUTED = ALL - 1 };

/* Index in category_name. */
static int find_category(slave_status status) { return status == SLAVE_OK ? ALL : (int)status - 1; }

/* Warnings and errors are always logged, other messages on request; a host that named categories gets those. */
static bool is_logged(const slave *s, slave_status status, int category) {
  if (s->all_categories) return s->logging || status != SLAVE_OK;
  return (s->categories & (1u << category | 1u << ALL)) != 0;
}

/* Number of bytes of the printable character of UTF-8 at a text; 0: there is none. */
static size_t measure_character(const char *text) {
  static const uint32_t smallest[] = {0, ' ', 0xa0, 0x800, 0x10000}; /* by number of bytes */
  const unsigned char *const bytes = (const unsigned char *)text, first = *bytes;
  const size_t n = first < 0x80 ? 1 : first < 0xc0 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf8 ? 4 : 0;
  uint32_t code = n > 1 ? first & 0x7fu >> n : first;
  for (size_t k = 1; k < n; k++) {
    if ((bytes[k] & 0xc0) != 0x80) return 0;
    code = code << 6 | (bytes[k] & 0x3f);
  }
  const bool is_surrogate = code >= 0xd800 && code <= 0xdfff;
  return code >= smallest[n] && code != 0x7f && code <= 0x10ffff && !is_surrogate ? n : 0;
}

/* Hands a message to the host, in one line. Texts of the host that it quotes may hold control characters, or end within
 * a character where they were cut: such bytes become question marks. */
static void pass_on(slave *s, slave_status status, int category, char *text) {
  for (char *c = text; *c != 0;) {
    const size_t n = measure_character(c);
    if (n == 0) *c = *c == '\n' || *c == '\t' ? ' ' : '?';
    c += n > 0 ? n : 1;
  }
  s->logger(s, status, category_name[category], text);
}

slave_status slave_log(slave *s, slave_status status, const char *format, ...) {
  char text[SLAVE_TEXT];
  va_list list;
  const int category = find_category(status);
  if (s->logger == NULL || !is_logged(s, status, category)) return status;
  va_start(list, format);
  vsnprintf(text, sizeof text, format, list);
  va_end(list);
  pass_on(s, status, category, text);
  return status;
}

void slave_log_uncomputed(slave *s, const slave_variable *v) {
  char text[SLAVE_TEXT], remedy[SLAVE_TEXT / 4] = "";
  const slave_table *t = &slave_the_table;
  size_t n = 0;
  if (s->logger == NULL || !is_logged(s, SLAVE_WARNING, NOT_COMPUTED)) return;
  for (size_t k = 0; k < t->n_systems && n < sizeof remedy / 2; k++)
    if (!(v->uncomputed >> k & 1)) n += (size_t)snprintf(remedy + n, sizeof remedy - n, "%s%zu", n > 0 ? ", " : "", k);
  if (n == 0)
    snprintf(text, sizeof text, "'%.128s' reads %g; this FMU does not compute it. This is reported once.", v->name,
             s->value[v - t->variable]);
  else
    snprintf(
        text, sizeof text,
        "'%.128s' reads %g: fidelity %zu does not compute it. To have it computed, set the parameter '%.64s' to one of "
        "%s before the start. This is reported once.",
        v->name, s->value[v - t->variable], s->fidelity.number, t->variable[s->fidelity_reference].name, remedy);
  pass_on(s, SLAVE_WARNING, NOT_COMPUTED, text);
}

slave_status slave_set_logging(slave *s, bool on, size_t n, const char *const *categories) {
  unsigned selected = 0;
  if (n > 0 && categories == NULL) return slave_log(s, SLAVE_ERROR, "The list of log categories is missing.");
  for (size_t i = 0; i < n; i++) {
    int k = 0;
    while (k < CATEGORIES && (categories[i] == NULL || strcmp(categories[i], category_name[k]) != 0)) k++;
    if (k == CATEGORIES)
      return slave_log(s, SLAVE_ERROR, "There is no log category '%.64s'; see modelDescription.xml for their names.",
                       categories[i] != NULL ? categories[i] : "");
    selected |= 1u << k;
  }
  s->logging = on;
  s->all_categories = n == 0 || !on;
  s->categories = on ? selected : 0;
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

bool slave_is_allowed(slave *s, const char *function, unsigned mask) {
  slave_reset_work(s);
  if (s->calls.phase & mask) return true;
  slave_log(s, SLAVE_ERROR, "%s is not allowed %s.", function, slave_phase_name(s->calls.phase));
  return false;
}
