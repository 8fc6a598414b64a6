/* What the files of the second motion share; what others use of it is in slave.h. */
#ifndef ALI3_HALF_STEPS_H
#define ALI3_HALF_STEPS_H

#include <math.h>
#include <string.h>

#include "slave.h"

static const double SPAN = 0.5; /* s after an abrupt step or a difference: five periods of a wheel, or a landing */
/* s: limit of the second motion from a start on in ALI3_MOST_PARTS parts, and after it besides a part of the simulated
 * time in which it costs as much as the first motion does in all. */
static const double BUDGET = 2.0;
static const double SHORT = 1.3e-3; /* s, steps that resolve a wheel on its tyre */

/* Factor by which durations of the second motion are longer with steps of h. Steps longer than ALI3_MOST_PARTS times
 * 2 SHORT belong to motions slower than a wheel; they count as steps of that length. */
static inline double stretch(double h) { return fmax(1.0, h / (2.0 * (double)ALI3_MOST_PARTS * SHORT)); }

/* Whether there is a road. Without one errors are of order two, and also grow without abrupt forces. */
static inline bool has_road(const slave *s) { return ali3_road_count(s->fidelity.system) > 0; }

/* Number of parts into which the second motion divides a step of h that was not halved. */
static inline int64_t nominal_parts(const slave *s, double h) {
  int64_t n = 2;
  while (has_road(s) && n < ALI3_MOST_PARTS && h / (double)n > SHORT) n *= 2;
  return n;
}

/* Duration of the second motion after a start, s, which costs as much as BUDGET in ALI3_MOST_PARTS parts. */
static inline double start_span(const slave *s, double h) {
  return BUDGET * (double)ALI3_MOST_PARTS / (double)nominal_parts(s, h);
}

/* Whether a relative difference of two motions is too large for them to agree. */
static inline bool disagree(double difference) { return difference > ALI3_AGREED * ALI3_WRONG_ERROR; }

/* Report of the kernel; zeros where there is none. */
static inline ali3_report get_report(const slave *s) {
  ali3_report report;
  if (ali3_report_get(s->fidelity.kernel, &report) != ALI3_OK) memset(&report, 0, sizeof report);
  return report;
}

/* Whether an output is compared: the loaded System computes it, and it has a comparison in the table. */
static inline bool is_compared(const slave_fidelity *f, const slave_variable *v) {
  return v->judged.unit >= 0 && !(v->uncomputed >> f->number & 1);
}

/* Number of compared outputs of a fidelity. */
static inline size_t compared_count(const slave_fidelity *f) {
  const slave_table *table = &slave_the_table;
  size_t n = 0;
  for (size_t i = table->n_known; i < table->n_variables; i++) n += is_compared(f, table->variable + i);
  return n;
}

/* Logged for hosts that ask for all messages, as it is no sign of an error. */
void slave_log_unchecked(slave *s, double time, const char *why);
/* Logs the result when the second motion ends. Without a road and abrupt forces, also predicts when the error is large,
 * from its growth between two windows of a start as a power of time. */
void slave_log_conclusion(slave *s, const slave_pending_step *step, double difference);
/* Logs a shared error or a difference after SPAN, or at the end of the run, and a prediction at its time. */
slave_status slave_report_motion(slave *s, double now, bool ended);

#endif
