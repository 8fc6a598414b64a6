/* What a state has of the second motion, from which it goes on as it was. */
#include "half_steps.h"

ali3_status slave_half_steps_check(const slave_fidelity *f, const unsigned char *bytes) {
  const size_t n = compared_count(f);
  slave_second_motion saved;
  memcpy(&saved, bytes, sizeof saved);
  if (saved.worst < 0 || (saved.worst > 0 && (size_t)saved.worst >= n)) return ALI3_BAD_STATE;
  const double finite[] = {saved.remaining, saved.spent, saved.simulated,        saved.difference,     saved.time,
                           saved.h,         saved.ratio, saved.early_difference, saved.late_difference};
  for (size_t i = 0; i < sizeof finite / sizeof *finite; i++)
    if (!isfinite(finite[i])) return ALI3_BAD_STATE;
  if (isnan(saved.scheduled) || isnan(saved.checked) || isnan(saved.predicted) || isnan(saved.shared))
    return ALI3_BAD_STATE;
  if (saved.difference > 0.0 && !(saved.parts >= 2 && saved.h > 0.0 && saved.ratio > 0.0)) return ALI3_BAD_STATE;
  return saved.remaining > 0.0 ? ali3_snapshot_check(f->kernel, bytes + sizeof saved + n * sizeof(ali3_compared))
                               : ALI3_OK;
}

/* Bytes of a state that are in use: a second motion that rests has no snapshot. */
static size_t used_size(const slave *s) {
  const slave_half_steps *t = &s->half_steps;
  return t->saved->remaining > 0.0 ? slave_half_steps_size(&s->fidelity)
                                   : sizeof *t->saved + (size_t)t->n * sizeof *t->compared;
}

void slave_half_steps_write(const slave *s, unsigned char *bytes) {
  if (s->half_steps.saved != NULL) memcpy(bytes, s->half_steps.saved, used_size(s));
}

void slave_half_steps_read(slave *s, const unsigned char *bytes) {
  slave_half_steps *t = &s->half_steps;
  slave_half_steps_begin(s);
  if (t->saved == NULL) return;
  memcpy(t->saved, bytes, sizeof *t->saved); /* says how much is in use */
  memcpy(t->saved, bytes, used_size(s));
}
