/* Where a force of a tyre, a contact or a spring with end stops changes abruptly, and where a run in long steps starts,
 * what follows is made a second time, until both agree for 0.5 s or its budget is spent, with half of a short step and
 * down to an eighth of a long one: what the outputs of both differ by is the error of the step. Without a road it is
 * foretold beyond, by how it grew. A run without either, or that has been told of one, pays nothing. The other
 * motion is a snapshot of the same instance; of short steps it makes the dear ones later, in cheaper calls. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "slave.h"

static const double SPAN = 0.5; /* s after an abrupt step or a difference: a wheel swings five times, or lands */
/* s from a start on in ALI3_MOST_PARTS parts, as a wheel spins; beside them s, and of what was driven: how much is made
 * twice at most. */
static const double BUDGET = 2.0, SHARE = 0.1;
static const double SHORT = 1.3e-3; /* s, steps that resolve a wheel on its tyre; a second costs no more than at 2 ms */
/* Iterations of both motions in an inner step of up to 2 SHORT: where it takes more the other one waits. */
static const int64_t ROOM = 7;
enum { MOST_LATE = 512 }; /* communication steps that may wait */

/* Whether all is made twice that may be of what was driven up to a step. */
static bool spent(const slave_half_steps *t, const slave_late_step *step) {
  return t->spent > BUDGET + SHARE * step->driven;
}

/* The error of a motion by what another with 1/n of its step differs by; of order two, as ALi3-P is. */
static double error_of(double apart, double n) { return apart * n * n / (n * n - 1.0); }

/* Of the kernel; zeros where it has none. */
static ali3_report report_of(const slave *s) {
  ali3_report report;
  if (ali3_report_get(s->fidelity.kernel, &report) != ALI3_OK) memset(&report, 0, sizeof report);
  return report;
}

/* Steps so far that were halved, or in which a force changed abruptly. */
static int64_t abrupt_steps(const ali3_report *report) { return report->abrupt_steps + report->halvings; }

/* Whether two motions that differ by this much do not agree. */
static bool differ(double apart) { return apart > ALI3_AGREED * ALI3_WRONG_ERROR; }

/* What is compared: outputs that the System at work computes, see `judged` of the table. */
static bool is_judged(const slave *s, const slave_variable *v) {
  return v->judged.unit >= 0 && !(v->uncomputed >> s->fidelity.number & 1);
}

/* Room for what is compared, in one block; false where that is nothing. */
static bool begin_comparison(slave *s) {
  slave_half_steps *t = &s->half_steps;
  const slave_table *table = &slave_the_table;
  size_t n = 0;
  if (t->seen != NULL) return true;
  for (size_t i = table->n_known; i < table->n_variables; i++) n += is_judged(s, table->variable + i);
  if (n == 0) return false;
  t->seen = s->memory.allocate(
      1, n * (sizeof(ali3_compared) + 2 * sizeof(double) + sizeof(ali3_judged) + sizeof(size_t) + sizeof(int32_t)));
  if (t->seen == NULL) return false;
  t->n = (int32_t)n;
  t->shown = (double *)(t->seen + n);
  t->size = t->shown + n;
  t->variable = (size_t *)(t->size + n);
  t->what = (ali3_judged *)(t->variable + n);
  t->sensor = (int32_t *)(t->what + n);
  for (size_t i = table->n_known, k = 0; k < n; i++) {
    if (!is_judged(s, table->variable + i)) continue;
    t->variable[k] = i;
    t->what[k] = table->variable[i].judged;
    t->sensor[k++] = table->variable[i].index;
  }
  return true;
}

static void forget(slave_half_steps *t) {
  t->apart = 0.0;
  for (int32_t i = 0; i < t->n; i++) t->seen[i].gap = 0.0;
}

/* In the log of a host that asks for all: it is no sign of an error. */
static void say_unchecked(slave *s, double time, const char *why) {
  if (s->event_said || s->unchecked_said) return;
  s->unchecked_said = true;
  slave_say(s, SLAVE_OK,
            "From %.4g s on no second motion is computed, so that the error is unknown: %s. This is "
            "reported once.",
            time, why);
}

/* From the state that is there now nothing is made twice, but for a start. */
void slave_half_steps_begin(slave *s) {
  slave_half_steps *t = &s->half_steps;
  if (t->left > 0.0 || t->n_late > 0) say_unchecked(s, ali3_time(s->fidelity.kernel), "a state was set");
  t->left = 0.0;
  t->sure = -HUGE_VAL; /* a run may start at any time */
  t->n_late = 0;
  t->cost = 0;
  t->made = 0;
  t->before = t->then = 0.0;
  t->origin = t->driven;
  t->foretold = HUGE_VAL;
  t->checked = -HUGE_VAL;
  t->begins = s->made.n == 0;
  if (!begin_comparison(s)) return;
  forget(t);
  if (t->begins) memset(t->seen, 0, (size_t)t->n * sizeof *t->seen);
  if (t->begins && ali3_some_sensors(s->fidelity.kernel, t->n, t->sensor, t->shown) == ALI3_OK)
    ali3_compare(t->what, t->n, 1, NULL, NULL, t->shown, t->seen);
  const ali3_report report = report_of(s);
  t->abrupt = abrupt_steps(&report);
  t->iterations = report.iterations;
}

/* Ranges of what is compared, at outputs that are looked at. */
void slave_half_steps_look(slave *s) {
  slave_half_steps *t = &s->half_steps;
  for (int32_t i = 0; i < t->n; i++) t->shown[i] = s->sensors[t->sensor[i]];
  ali3_compare(t->what, t->n, 1, NULL, NULL, t->shown, t->seen);
}

static size_t inputs_of(const slave *s) { return (size_t)ali3_system_sizes(s->fidelity.system).nu; }

/* Work of one block: snapshots of this motion at the end of the step and where the other one begins, and of the other,
 * its inputs; of each step that waits inputs, what it shows, parameters. */
static bool allocate(slave *s) {
  slave_half_steps *t = &s->half_steps;
  const size_t size = ali3_snapshot_size(s->fidelity.system), nu = inputs_of(s),
               np = (size_t)ali3_system_sizes(s->fidelity.system).np, each = nu + (size_t)t->n + np;
  if (t->end != NULL || t->seen == NULL) return t->end != NULL;
  t->end =
      s->memory.allocate(1, 3 * size + (nu + MOST_LATE * each) * sizeof(double) + MOST_LATE * sizeof(slave_late_step));
  if (t->end == NULL) return false;
  t->other = (unsigned char *)t->end + size;
  t->start = (unsigned char *)t->other + size;
  t->late = (slave_late_step *)((unsigned char *)t->start + size);
  t->input = (double *)(t->late + MOST_LATE);
  for (size_t i = 0; i < MOST_LATE; i++) {
    t->late[i].number = t->input + nu + i * each;
    t->late[i].parameter = t->late[i].number + each - np;
  }
  ali3_snapshot_take(s->fidelity.kernel, t->other); /* one that can be set, until the other motion begins */
  return true;
}

void slave_half_steps_free(slave *s) {
  if (s->half_steps.end != NULL) s->memory.release(s->half_steps.end);
  if (s->half_steps.seen != NULL) s->memory.release(s->half_steps.seen);
  memset(&s->half_steps, 0, sizeof s->half_steps);
}

/* Whether there is a road: without one errors are of order two, and come without an abrupt force too. */
static bool has_road(const slave *s) { return ali3_road_count(s->fidelity.system) > 0; }

/* In how many parts the other motion makes a step. */
static int64_t parts_of(const slave *s, double h) {
  int64_t n = 2;
  while (has_road(s) && n < ALI3_MOST_PARTS && h / (double)n > SHORT) n *= 2;
  return n;
}

/* s from a start on that are made twice: at the cost of ALI3_MOST_PARTS parts. */
static double start_of(const slave *s, double h) { return BUDGET * (double)ALI3_MOST_PARTS / (double)parts_of(s, h); }

/* One inner step of the communication step that waits longest, by the other motion, which the kernel has; slopes are
 * those of the present one, which does not wait if it has them. */
static ali3_status make(slave *s, const slave_late_step *step) {
  slave_half_steps *t = &s->half_steps;
  const size_t nu = inputs_of(s);
  const double h = step->h / (double)parts_of(s, step->h);
  memcpy(t->input, step->number, nu * sizeof(double));
  if (t->made++ == 0) {
    const ali3_status status = slave_set_step(s, step->parameter, t->input);
    if (status != ALI3_OK) return status;
  }
  if (step->sloped) slave_inputs_at(s, (double)t->made * h, t->input);
  return ali3_run(s->fidelity.kernel, h, 1, t->input, 1, NULL, NULL, NULL);
}

/* Before the first inner step of one that waited. Returns whether it is made: up to SPAN after the last abrupt one or
 * the last after which both differed, unless what that may cost is spent. */
static bool begin(slave *s, const slave_late_step *step) {
  slave_half_steps *t = &s->half_steps;
  const bool rests = !(t->left > 0.0);
  t->started = t->started && !step->starts;
  if (step->span > 0.0 && !spent(t, step) && (!rests || step->starts)) {
    if (rests) ali3_snapshot_restore(s->fidelity.kernel, t->start);
    t->left = fmax(t->left, step->span);
  } else if (step->span > 0.0) {
    say_unchecked(s, step->end, spent(t, step) ? "the time of the second motion is spent" : "one of them failed");
  }
  return t->left > 0.0;
}

/* When the other motion ends: what is known and, without a road and a stop that was met, when the error is large by how
 * it grew between the last two windows of a start, as a power of the time. */
static void conclude(slave *s, const slave_late_step *step, double apart) {
  slave_half_steps *t = &s->half_steps;
  const double n = (double)parts_of(s, step->h), error = error_of(t->then, n);
  char why[SLAVE_TEXT / 4], grows[SLAVE_TEXT / 8] = "";
  if (has_road(s) && !differ(apart)) return; /* until the next abrupt force */
  const bool first = t->checked == -HUGE_VAL; /* later windows begin after an abrupt force, and are short */
  if (first) t->checked = step->end;
  if (first && !has_road(s) && t->abrupt == 0 && t->before > 0.0 && t->then > t->before) {
    const double length = step->driven - t->origin,
                 power = log(t->then / t->before) / log(2.0 * length / start_of(s, step->h));
    t->foretold = step->end + length * (pow(ALI3_WRONG_ERROR / error, 1.0 / power) - 1.0);
    snprintf(grows, sizeof grows, ", and this grows as time to the power %.2g", power);
  }
  snprintf(why, sizeof why, "%scomputed again with 1/%.0f of them, outputs differed by %.2g %% at last%s",
           differ(apart) ? "the time of the second motion is spent; " : "", n, 100.0 * apart, grows);
  say_unchecked(s, step->end, why);
}

/* What both motions differ by at the end of a communication step. */
static void compare(slave *s, const slave_late_step *step) {
  slave_half_steps *t = &s->half_steps;
  const double length = (double)step->n * step->h, start = start_of(s, step->h);
  int32_t worst;
  ali3_some_sensors(s->fidelity.kernel, t->n, t->sensor, t->shown);
  ali3_compare(t->what, t->n, 1, &step->end, step->number + inputs_of(s), t->shown, t->seen);
  ali3_compared_sizes(t->what, t->n, t->seen, slave_the_table.length, report_of(s).energy_floor, 0, t->size);
  const double apart = ali3_compared_error(t->n, t->seen, t->size, 1, &worst);
  if (apart > t->apart) {
    t->apart = apart;
    t->time = step->end;
    t->h = step->h;
  }
  if (step->driven - t->origin <= 0.5 * start) {
    if (step->driven - t->origin > 0.25 * start) t->before = fmax(t->before, apart);
  } else if (apart > t->then) {
    t->then = apart;
    t->worst = worst;
  }
  t->left -= length;
  if (differ(apart) && !spent(t, step)) t->left = fmax(t->left, SPAN); /* it may still grow, as of a wheel that spins */
  t->spent += length;
  if (!(t->left > 0.0)) conclude(s, step, apart);
}

/* One inner step of the other motion, which the kernel has, in the communication step that waits longest, unless that one
 * is not made twice. Returns the iterations. */
static int64_t follow(slave *s) {
  slave_half_steps *t = &s->half_steps;
  const slave_late_step *step = t->late + t->first;
  int64_t cost = 0;
  if (t->made > 0 || begin(s, step)) {
    const int64_t before = report_of(s).iterations;
    const bool good = make(s, step) == ALI3_OK;
    cost = report_of(s).iterations - before;
    if (good && t->made < parts_of(s, step->h) * step->n) return cost;
    if (good)
      compare(s, step);
    else
      t->left = 0.0;
  }
  t->made = 0;
  t->first = (t->first + 1) % MOST_LATE;
  t->n_late--;
  return cost;
}

/* The other motion through steps that wait, down to `most` of them, and on while there is room for the iterations of a
 * step of it beside those that were `made` in this call; the kernel comes back to this motion. */
static void catch_up(slave *s, size_t most, int64_t made, int64_t room) {
  slave_half_steps *t = &s->half_steps;
  ali3_instance *kernel = s->fidelity.kernel;
  if (t->n_late <= most && made + t->cost > room) {
    if (t->cost > 0) t->cost--; /* of one dear step, others may be cheaper */
    return;
  }
  ali3_snapshot_take(kernel, t->end);
  ali3_snapshot_restore(kernel, t->other);
  while (t->n_late > 0 && (t->n_late > most || made + t->cost <= room)) {
    const int64_t cost = follow(s);
    made += cost;
    if (cost > 0) t->cost = cost;
  }
  ali3_snapshot_take(kernel, t->other);
  ali3_snapshot_restore(kernel, t->end);
}

/* The communication step that was made, to those that wait. `span`: s for which an abrupt one is followed, 0: it is
 * none. */
static void put_off(slave *s, double now, double span) {
  slave_half_steps *t = &s->half_steps;
  const double begin = now - (double)s->made.n * s->made.h;
  const bool starts = span > 0.0 && !(begin < t->sure - 0.5 * (now - begin)); /* the other clock has other round-off */
  if (starts && t->n_late > 0 && t->started) catch_up(s, 0, 0, 0); /* `start` is still needed */
  slave_late_step *step = t->late + (t->first + t->n_late++) % MOST_LATE;
  if (starts) memcpy(t->start, s->fidelity.start, ali3_snapshot_size(s->fidelity.system));
  t->started = starts || (t->started && t->n_late > 1);
  if (span > 0.0) t->sure = fmax(t->sure, begin + span);
  slave_look_at_step(s, step->parameter, step->number);
  slave_inputs_at(s, 0.0, step->number);
  ali3_some_sensors(s->fidelity.kernel, t->n, t->sensor, step->number + inputs_of(s));
  *step = (slave_late_step){.n = s->made.n,
                            .h = s->made.h,
                            .end = now,
                            .span = span,
                            .driven = t->driven,
                            .number = step->number,
                            .parameter = step->parameter,
                            .sloped = s->made.sloped,
                            .starts = starts};
}

/* The largest difference, when what comes later has shown how large forces and ranges are. */
static slave_status judge(slave *s) {
  slave_half_steps *t = &s->half_steps;
  int32_t worst;
  ali3_compared_sizes(t->what, t->n, t->seen, slave_the_table.length, report_of(s).energy_floor, 0, t->size);
  const double n = (double)parts_of(s, t->h), h = t->h, apart = ali3_compared_error(t->n, t->seen, t->size, 0, &worst),
               error = error_of(apart, n);
  const bool met = error <= n * ALI3_WRONG_ERROR; /* by the step of the other motion, by order one, as at a kink */
  if (!(error > ALI3_WRONG_ERROR)) {
    forget(t);
    return SLAVE_OK;
  }
  const slave_variable *v = slave_the_table.variable + t->variable[worst];
  const double off = fabs(v->scale) * error * t->size[worst];
  s->event_said = true;
  const bool load = (v->judged.kind & ALI3_JUDGED_LOAD) != 0;
  return slave_say(s, SLAVE_WARNING,
                   "At %.4g s the motion was too fast for the step: computed again with 1/%.0f of it, %s is off by %s "
                   "%.*g%s, %.2g %% of "
                   "the largest %s at communication points. Run again with a step_size of %.2g s%s. This is reported "
                   "once.",
                   t->seen[worst].time, n, v->name, t->n_late > 0 ? "at least" : "about", load ? 15 : 3,
                   load ? round(off) : off, v->unit, 100.0 * error, load ? "force" : "range in its unit",
                   h / n / ceil(error / (n * ALI3_WRONG_ERROR)), met ? ", as was tried" : ", which was not tried");
}

/* Where the error that was seen grows on as it did. */
static slave_status foretell(slave *s, double now) {
  const slave_half_steps *t = &s->half_steps;
  s->event_said = true;
  return slave_say(s, SLAVE_WARNING,
                   "At %.4g s %s may be off by %.0f %% of the largest range in its unit: computed again with 1/%.0f of "
                   "the step up to %.4g s it was off by %.2g %%, and this grows as it did until then. Compare with a "
                   "run of half the step_size, %g s. This is reported once.",
                   now, slave_the_table.variable[t->variable[t->worst]].name, 100.0 * ALI3_WRONG_ERROR,
                   (double)parts_of(s, t->h), t->checked, 100.0 * error_of(t->then, (double)parts_of(s, t->h)),
                   0.5 * t->h);
}

/* What can be said by now, or when the run has `ended`. */
static slave_status tell(slave *s, double now, bool ended) {
  const slave_half_steps *t = &s->half_steps;
  const slave_status judged = t->apart > 0.0 && (ended || now > t->time + SPAN) ? judge(s) : SLAVE_OK;
  return s->event_said || now < t->foretold ? judged : foretell(s, now);
}

/* What is not judged when the run ends, also where the host resets or frees it without a word. */
void slave_half_steps_end(slave *s) {
  if (s->event_said || !(s->calls.phase & (SLAVE_STEPPING | SLAVE_STEP_FAILED))) return;
  if (s->half_steps.n_late > 0) catch_up(s, 0, 0, 0);
  tell(s, ali3_time(s->fidelity.kernel), true);
}

/* After a good communication step whose start the fidelity keeps; before slopes are forgotten. */
slave_status slave_halve_steps(slave *s) {
  slave_half_steps *t = &s->half_steps;
  ali3_report report;
  if (s->event_said || ali3_report_get(s->fidelity.kernel, &report) != ALI3_OK) return SLAVE_OK;
  /* what is let go swings; tyres that are driven from the start on slip at once, which long steps miss */
  const bool begins = t->begins && (!has_road(s) || 2.0 * s->made.h > (double)ALI3_MOST_PARTS * SHORT),
             abrupt = abrupt_steps(&report) > t->abrupt || begins;
  const int64_t made = report.iterations - t->iterations;
  const double length = (double)s->made.n * s->made.h, now = ali3_time(s->fidelity.kernel);
  t->abrupt = abrupt_steps(&report);
  t->iterations = report.iterations;
  t->begins = false;
  if (begins && !(t->driven > 0.0)) t->spent = -start_of(s, s->made.h); /* beside what abrupt forces may cost */
  t->driven += length;
  if (abrupt && !allocate(s)) return SLAVE_OK;
  if (t->end != NULL && (abrupt || t->left > 0.0 || t->n_late > 0)) {
    const bool waits = parts_of(s, s->made.h) == 2 && !s->made.sloped;
    put_off(s, now, abrupt ? (begins ? start_of(s, s->made.h) : SPAN) : 0.0);
    catch_up(s, waits ? MOST_LATE - 1 : 0, made, ROOM * s->made.n);
  }
  return tell(s, now, false);
}
