/* What is reported of the second motion: a difference from the first one, a growing or a shared error, and its end. */
#include <stdio.h>

#include "half_steps.h"

void slave_log_unchecked(slave *s, double time, const char *why) {
  if (s->error_warned || s->unchecked_logged) return;
  s->unchecked_logged = true;
  slave_log(s, SLAVE_OK,
            "From %.4g s on no second motion is computed, so that the error is unknown: %s. This is reported once.",
            time, why);
}

/* Clears the largest differences seen so far. */
static void reset_difference(slave_half_steps *t) {
  t->saved->difference = 0.0;
  for (int32_t i = 0; i < t->n; i++) t->compared[i].gap = 0.0;
}

/* Richardson extrapolation: error of a motion from its difference to one with 1/n of the step, for order two as of
 * ALi3-P. */
static double extrapolated_error(double difference, double n) { return difference * n * n / (n * n - 1.0); }

void slave_log_conclusion(slave *s, const slave_pending_step *step, double difference) {
  slave_half_steps *t = &s->half_steps;
  const double error = extrapolated_error(t->saved->late_difference, step->ratio);
  char why[SLAVE_TEXT / 4], grows[SLAVE_TEXT / 8] = "";
  if (has_road(s) && !disagree(difference)) return; /* until the next abrupt force */
  const bool first = t->saved->checked == -HUGE_VAL; /* later windows follow an abrupt force and are short */
  if (first) t->saved->checked = step->end;
  if (first && !has_road(s) && t->abrupt == 0 && t->saved->early_difference > 0.0 &&
      t->saved->late_difference > t->saved->early_difference) {
    const double length = step->simulated, power = log(t->saved->late_difference / t->saved->early_difference) /
                                                   log(2.0 * length / start_span(s, step->h));
    t->saved->predicted = step->end + stretch(step->h) * length * (pow(ALI3_WRONG_ERROR / error, 1.0 / power) - 1.0);
    snprintf(grows, sizeof grows, ", and this grows as time to the power %.2g", power);
  }
  snprintf(why, sizeof why, "%scomputed again with 1/%.0f of them, outputs differed by %.2g %% at last%s",
           disagree(difference) ? "the time of the second motion is spent; " : "", (double)step->parts,
           100.0 * difference, grows);
  slave_log_unchecked(s, step->end, why);
}

/* Logs the largest difference as an error, now that forces and ranges after it are known. */
static slave_status report_difference(slave *s) {
  slave_half_steps *t = &s->half_steps;
  int32_t worst;
  ali3_compared_sizes(t->judged, t->n, t->compared, slave_the_table.length, get_report(s).energy_floor, 0, t->size);
  const double h = t->saved->h / (double)t->saved->parts,
               difference = ali3_compared_error(t->n, t->compared, t->size, 0, &worst),
               error = extrapolated_error(difference, t->saved->ratio);
  /* the step of the second motion suffices at order one, as at a kink */
  const bool met = error <= t->saved->ratio * ALI3_WRONG_ERROR;
  if (!(error > ALI3_WRONG_ERROR)) {
    reset_difference(t);
    return SLAVE_OK;
  }
  const slave_variable *v = slave_the_table.variable + t->variable[worst];
  const double off = fabs(v->scale) * error * t->size[worst] / v->judged.factor;
  s->error_warned = true;
  const bool large = off >= 999.5; /* shown without an exponent */
  return slave_log(
      s, SLAVE_WARNING,
      "At %.4g s the motion was too fast for the step: computed again with 1/%.0f of it, %s is off by %s "
      "%.*g%s, %.2g %% of the largest %s in its unit at communication points. Run again with a step_size of %.2g s%s. "
      "This is reported once.",
      t->compared[worst].time, (double)t->saved->parts, v->name, t->n_pending > 0 ? "at least" : "about",
      large ? 15 : 3, large ? round(off) : off, v->unit, 100.0 * error,
      v->judged.kind & ALI3_JUDGED_LOAD ? "load" : "range", h / ceil(error / (t->saved->ratio * ALI3_WRONG_ERROR)),
      met ? ", as was tried" : ", which was not tried");
}

/* Logs the predicted error of a start. */
static slave_status report_prediction(slave *s, double now) {
  const slave_half_steps *t = &s->half_steps;
  s->error_warned = true;
  return slave_log(s, SLAVE_WARNING,
                   "At %.4g s %s may be off by %.0f %% of the largest range in its unit: computed again with 1/%.0f of "
                   "the step up to %.4g s it was off by %.2g %%, and this grows as it did until then. Compare with a "
                   "run of half the step_size, %g s. This is reported once.",
                   now, slave_the_table.variable[t->variable[t->saved->worst]].name, 100.0 * ALI3_WRONG_ERROR,
                   (double)t->saved->parts, t->saved->checked,
                   100.0 * extrapolated_error(t->saved->late_difference, t->saved->ratio), 0.5 * t->saved->h);
}

/* Logs that both motions have a wrong energy. */
static slave_status report_shared_error(slave *s) {
  const ali3_report report = get_report(s);
  const double h = s->completed.h;
  s->error_warned = true;
  return slave_log(
      s, SLAVE_WARNING,
      "Up to %.4g s the steps have added or lost %.3g J without a force, %.2g %% of the energy in the "
      "motion, and shorter steps lost more than half as much, as past a position in which bodies of a loop "
      "lie in line: by how much outputs are off is not known. Run again with a step_size of %.2g s or "
      "less, which was not tried, until this is not reported.",
      ali3_time(s->fidelity.kernel), report.energy_error, 100.0 * ali3_energy_balance(&report),
      h / (double)ALI3_MOST_PARTS);
}

slave_status slave_report_motion(slave *s, double now, bool ended) {
  const slave_half_steps *t = &s->half_steps;
  const slave_status judged =
      t->saved->difference > 0.0 && (ended || now > t->saved->time + SPAN * stretch(t->saved->h)) ? report_difference(s)
                                                                                                  : SLAVE_OK;
  if (!s->error_warned && !s->calls.energy_warned &&
      (ended ? isfinite(t->saved->shared) : now > t->saved->shared + SPAN * stretch(s->completed.h)))
    return report_shared_error(s);
  return s->error_warned || now < t->saved->predicted ? judged : report_prediction(s, now);
}
