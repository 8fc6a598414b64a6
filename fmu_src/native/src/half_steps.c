/* Where a force of a tyre, a contact or a spring with end stops changes abruptly, and where a run in long steps starts,
 * what follows is made a second time, until both agree for 0.4 s or its budget is spent, with half of a short step and
 * down to an eighth of a long one: what both differ by is the error of the step. A run without either, or that has been
 * told of one, pays nothing. The other motion is a snapshot of the same instance; of short steps it makes the dear ones
 * later, in cheaper calls. */
#include <math.h>
#include <string.h>

#include "slave.h"

static const double SPAN = 0.4; /* s after an abrupt step or a difference: a wheel swings four times */
static const double START = 2.0; /* s from a start: a wheel that spins grips again as late as after 0.9 s */
static const double LATER = 0.5; /* s after a difference in which the largest force comes: a wheel lands */
static const double JUMP = 0.05; /* of its range: an input that jumps */
static const double WRONG = 0.05; /* of the largest force at communication points */
static const double AGREED = 0.1; /* of WRONG: a larger difference may still grow, as of a wheel that spins */
static const double SHORT = 1.3e-3; /* s, steps that resolve a wheel on its tyre; a second costs no more than at 2 ms */
static const int64_t MOST = 8; /* parts of a step */
static const double SAFE = 0.6; /* of WRONG: what a step that was not tried would do with, by order one as at a kink */
static const double FREE = 2.0, SHARE = 0.1; /* s, and of the time driven: how much is made twice at most */
/* Iterations of both motions in an inner step of up to 2 SHORT: where it takes more the other one waits. */
static const int64_t ROOM = 7;
enum { MOST_LATE = 512 }; /* communication steps that may wait */

/* Whether all is made twice that may be of what was driven up to a step. */
static bool spent(const slave_half_steps *t, const slave_late_step *step) {
  return t->spent > FREE + SHARE * step->driven;
}

/* From the state that is there now nothing is made twice, but for a start. */
void slave_half_steps_begin(slave *s) {
  slave_half_steps *t = &s->half_steps;
  ali3_report report;
  t->alone = t->alone || t->left > 0.0 || t->n_late > 0 || t->apart > 0.0;
  t->left = t->apart = 0.0;
  t->sure = -HUGE_VAL; /* a run may start at any time */
  t->n_late = 0;
  t->cost = 0;
  t->made = 0;
  t->begins = s->made.n == 0;
  if (ali3_report_get(s->fidelity.kernel, &report) != ALI3_OK) memset(&report, 0, sizeof report);
  t->abrupt = report.abrupt_steps;
  t->iterations = report.iterations;
}

static size_t inputs_of(const slave *s) { return (size_t)ali3_system_sizes(s->fidelity.system).nu; }

/* How many forces are compared, of tyres all or their loads only. */
static size_t forces_of(const slave *s, bool all) { return (size_t)ali3_contact_forces(s->fidelity.kernel, all, NULL); }

/* Work of one block: snapshots of this motion at the end of the step and where the other one begins, and of the other,
 * its forces, inputs; of each step that waits inputs, both kinds of forces, parameters. */
static bool allocate(slave *s) {
  slave_half_steps *t = &s->half_steps;
  const size_t size = ali3_snapshot_size(s->fidelity.system), n = forces_of(s, true), nu = inputs_of(s),
               np = (size_t)ali3_system_sizes(s->fidelity.system).np, each = nu + n + forces_of(s, false) + np;
  if (t->end != NULL) return true;
  t->end = s->memory.allocate(1, 3 * size + (n + 2 * nu + MOST_LATE * each) * sizeof(double) +
                                     MOST_LATE * sizeof(slave_late_step));
  if (t->end == NULL) return false;
  t->other = (unsigned char *)t->end + size;
  t->start = (unsigned char *)t->other + size;
  t->late = (slave_late_step *)((unsigned char *)t->start + size);
  t->force = (double *)(t->late + MOST_LATE);
  t->input = t->force + n;
  for (size_t i = 0; i < MOST_LATE; i++) {
    t->late[i].number = t->input + 2 * nu + i * each;
    t->late[i].parameter = t->late[i].number + each - np;
  }
  ali3_snapshot_take(s->fidelity.kernel, t->other); /* one that can be set, until the other motion begins */
  return true;
}

void slave_half_steps_free(slave *s) {
  if (s->half_steps.end != NULL) s->memory.release(s->half_steps.end);
  memset(&s->half_steps, 0, sizeof s->half_steps);
}

/* Whether an input goes on from the last step by much of its range: tyres then differ for a few steps in what follows
 * it, and only their loads are compared. */
static bool jumps(const slave *s, const double *input) {
  const slave_table *t = &slave_the_table;
  for (size_t i = 0; i < t->n_known; i++) {
    const slave_variable *v = &t->variable[i];
    double was;
    if (v->source != SLAVE_INPUT || ali3_get_input(s->fidelity.kernel, v->index, &was) != ALI3_OK) continue;
    if (fabs(v->scale * (input[v->index] - was)) > JUMP * (v->max - v->min)) return true;
  }
  return false;
}

/* In how many parts the other motion makes a step. */
static int64_t parts_of(double h) {
  int64_t n = 2;
  while (n < MOST && h / (double)n > SHORT) n *= 2;
  return n;
}

/* One inner step of the communication step that waits longest, by the other motion, which the kernel has; slopes are
 * those of the present one, which does not wait if it has them. */
static ali3_status make(slave *s, const slave_late_step *step) {
  slave_half_steps *t = &s->half_steps;
  const size_t nu = inputs_of(s);
  const double h = step->h / (double)parts_of(step->h);
  memcpy(t->input, step->number, nu * sizeof(double));
  if (t->made++ == 0) {
    t->jumped = t->jumped || jumps(s, t->input);
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
  if (step->span > 0.0 && (spent(t, step) || (rests && !step->starts))) {
    t->alone = true;
  } else if (step->span > 0.0) {
    if (rests) ali3_snapshot_restore(s->fidelity.kernel, t->start);
    t->jumped = t->jumped && !rests;
    t->alone = t->alone && !rests;
    t->left = fmax(t->left, step->span);
  }
  return t->left > 0.0;
}

/* What both motions differ by at the end of a communication step. */
static void compare(slave *s, const slave_late_step *step) {
  slave_half_steps *t = &s->half_steps;
  const double length = (double)step->n * step->h;
  const double *own = step->number + inputs_of(s) + (t->jumped ? forces_of(s, true) : 0);
  const int32_t n = ali3_contact_forces(s->fidelity.kernel, !t->jumped, t->force);
  double apart = 0.0;
  for (int32_t i = 0; i < n; i++) apart = fmax(apart, fabs(t->force[i] - own[i]));
  if (apart > t->apart) {
    t->apart = apart;
    t->time = step->end;
    t->h = step->h;
  }
  t->left -= length;
  if (apart > AGREED * WRONG * step->largest && !spent(t, step)) t->left = fmax(t->left, SPAN);
  t->spent += length;
}

static int64_t iterations(const slave *s) {
  ali3_report report;
  return ali3_report_get(s->fidelity.kernel, &report) == ALI3_OK ? report.iterations : 0;
}

/* One inner step of the other motion, which the kernel has, in the communication step that waits longest, unless that one
 * is not made twice. Returns the iterations. */
static int64_t follow(slave *s) {
  slave_half_steps *t = &s->half_steps;
  const slave_late_step *step = t->late + t->first;
  int64_t cost = 0;
  if (t->made > 0 || begin(s, step)) {
    const int64_t before = iterations(s);
    const bool good = make(s, step) == ALI3_OK;
    cost = iterations(s) - before;
    if (good && t->made < parts_of(step->h) * step->n) return cost;
    if (good) {
      compare(s, step);
    } else {
      t->left = 0.0;
      t->alone = true;
    }
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
  double *own = step->number + inputs_of(s);
  if (starts) memcpy(t->start, s->fidelity.start, ali3_snapshot_size(s->fidelity.system));
  t->started = starts || (t->started && t->n_late > 1);
  if (span > 0.0) t->sure = fmax(t->sure, begin + span);
  slave_look_at_step(s, step->parameter, step->number);
  slave_inputs_at(s, 0.0, step->number);
  ali3_contact_forces(s->fidelity.kernel, 1, own);
  ali3_contact_forces(s->fidelity.kernel, 0, own + forces_of(s, true));
  *step = (slave_late_step){.n = s->made.n,
                            .h = s->made.h,
                            .end = now,
                            .span = span,
                            .driven = t->driven,
                            .largest = t->largest,
                            .number = step->number,
                            .parameter = step->parameter,
                            .sloped = s->made.sloped,
                            .starts = starts};
}

/* The largest difference, when what comes later has shown how large forces are. */
static slave_status judge(slave *s, const ali3_report *r) {
  slave_half_steps *t = &s->half_steps;
  const double n = (double)parts_of(t->h), order_2 = n * n / (n * n - 1.0);
  const double off = order_2 * t->apart, error = off / t->largest, h = t->h;
  const bool met = error <= n * WRONG; /* by the step of the other motion, by order one */
  t->apart = 0.0;
  if (!(error > WRONG)) return SLAVE_OK;
  if (slave_event_told(r)) return slave_say_event(s, r);
  s->event_said = true;
  return slave_say(
      s, SLAVE_WARNING,
      "At %.4g s a tyre, a contact or a stop had changed a force too quickly for the step: made again with "
      "1/%.0f of it, forces are off by %s %.0f N, %.2g %% of the largest at communication points. Run again "
      "with a step_size of %.2g s%s. This is said once.",
      t->time, n, t->n_late > 0 ? "at least" : "about", off, 100.0 * error, met ? h / n : h * SAFE * WRONG / error,
      met ? ", as was tried" : ", which was not tried");
}

/* What can be said by now, or when the run has `ended`. */
static slave_status tell(slave *s, const ali3_report *r, double now, bool ended) {
  const slave_half_steps *t = &s->half_steps;
  const bool told = slave_event_told(r), waits = t->n_late > 0;
  slave_status status = SLAVE_OK;
  if (t->apart > 0.0 && (ended || told || now > t->time + LATER)) status = judge(s, r);
  if (s->event_said || !t->alone || !told || ((t->left > 0.0 || waits) && !ended)) return status;
  return slave_say_event(s, r);
}

/* What is not judged when the run ends, also where the host resets or frees it without a word. */
void slave_half_steps_end(slave *s) {
  ali3_report report;
  if (s->event_said || !(s->calls.phase & (SLAVE_STEPPING | SLAVE_STEP_FAILED))) return;
  if (s->half_steps.n_late > 0) catch_up(s, 0, 0, 0);
  if (ali3_report_get(s->fidelity.kernel, &report) == ALI3_OK) tell(s, &report, 0.0, true);
}

/* After a good communication step whose start the fidelity keeps; before slopes are forgotten. */
slave_status slave_halve_steps(slave *s) {
  slave_half_steps *t = &s->half_steps;
  ali3_report report;
  if (s->event_said || ali3_report_get(s->fidelity.kernel, &report) != ALI3_OK) return SLAVE_OK;
  /* tyres that are driven from the start on slip at once, where long steps miss it */
  const bool begins = t->begins && parts_of(s->made.h) == MOST && ali3_contact_forces(s->fidelity.kernel, 1, NULL) > 0,
             abrupt = report.abrupt_steps > t->abrupt || begins;
  const int64_t made = report.iterations - t->iterations;
  const double length = (double)s->made.n * s->made.h, now = ali3_time(s->fidelity.kernel);
  t->abrupt = report.abrupt_steps;
  t->iterations = report.iterations;
  t->begins = false;
  if (begins && !(t->driven > 0.0)) t->spent = -START; /* beside what abrupt forces may cost */
  t->driven += length;
  t->largest = fmax(t->largest, ali3_largest_contact_force(s->fidelity.kernel));
  if (abrupt && !allocate(s)) t->alone = true;
  if (t->end != NULL && (abrupt || t->left > 0.0 || t->n_late > 0)) {
    const bool waits = parts_of(s->made.h) == 2 && !s->made.sloped;
    put_off(s, now, abrupt ? (begins ? START : SPAN) : 0.0);
    catch_up(s, waits ? MOST_LATE - 1 : 0, made, ROOM * s->made.n);
  }
  return tell(s, &report, now, false);
}
