/* Where a force of a tyre, a contact or a spring with end stops changes abruptly, and where a run in long steps starts,
 * what follows is made a second time, until both agree for 0.4 s or what that may cost is spent, with half of a short
 * step and down to an eighth of a long one: what both differ by is the error of the step. A run without either, or that
 * has been told of one, pays nothing. The other motion is a snapshot of the same instance. */
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
static const double SAFE = 0.6; /* of WRONG: what a step would do with, by order one as at a kink */
static const double FREE = 2.0, SHARE = 0.1; /* s, and of the time driven: how much is made twice at most */

/* From the state that is there now nothing is made twice, but for a start. */
void slave_half_steps_begin(slave *s) {
  slave_half_steps *t = &s->half_steps;
  ali3_report report;
  t->alone = t->alone || t->left > 0.0 || t->apart > 0.0;
  t->left = t->apart = 0.0;
  t->begins = s->made.n == 0;
  t->abrupt = ali3_report_get(s->fidelity.kernel, &report) == ALI3_OK ? report.abrupt_steps : 0;
}

/* Work of one block: the snapshot of this motion at the end of the step, that of the other, forces of both, inputs. */
static bool allocate(slave *s) {
  slave_half_steps *t = &s->half_steps;
  const size_t size = ali3_snapshot_size(s->fidelity.system),
               n = (size_t)ali3_contact_forces(s->fidelity.kernel, 1, NULL);
  const ali3_sizes z = ali3_system_sizes(s->fidelity.system);
  if (t->end != NULL) return true;
  t->end = s->memory.allocate(1, 2 * size + (2 * n + (size_t)(2 * z.nu + z.np)) * sizeof(double));
  if (t->end == NULL) return false;
  t->other = (unsigned char *)t->end + size;
  t->force = (double *)((unsigned char *)t->other + size);
  t->input = t->force + 2 * n;
  t->parameter = t->input + 2 * z.nu;
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

/* The communication step from the state of `other`, with inputs and parameters of the one that was made. */
static ali3_status make(slave *s) {
  slave_half_steps *t = &s->half_steps;
  ali3_instance *kernel = s->fidelity.kernel;
  const ali3_sizes z = ali3_system_sizes(s->fidelity.system);
  const int64_t n = parts_of(s->made.h);
  const double h = s->made.h / (double)n;
  slave_look_at_step(s, t->parameter, t->input);
  slave_inputs_at(s, 0.0, t->input);
  ali3_snapshot_restore(kernel, t->other);
  t->jumped = t->jumped || jumps(s, t->input);
  ali3_status status = slave_set_step(s, t->parameter, t->input);
  for (int64_t k = 1; k <= n * s->made.n && status == ALI3_OK; k++) {
    memcpy(t->input + z.nu, t->input, (size_t)z.nu * sizeof(double));
    slave_inputs_at(s, (double)k * h, t->input + z.nu);
    status = ali3_run(kernel, h, 1, t->input + z.nu, 1, NULL, NULL, NULL);
  }
  return status;
}

/* The other motion through the communication step, which ends at `now`; the kernel comes back to this one. Returns the
 * difference, N. */
static double follow(slave *s, double now) {
  slave_half_steps *t = &s->half_steps;
  ali3_instance *kernel = s->fidelity.kernel;
  ali3_snapshot_take(kernel, t->end);
  const bool good = make(s) == ALI3_OK;
  const int32_t n = ali3_contact_forces(kernel, !t->jumped, t->force);
  if (good) ali3_snapshot_take(kernel, t->other);
  ali3_snapshot_restore(kernel, t->end);
  if (!good) {
    t->left = 0.0;
    t->alone = true;
    return 0.0;
  }
  ali3_contact_forces(kernel, !t->jumped, t->force + n);
  double apart = 0.0;
  for (int32_t i = 0; i < n; i++) apart = fmax(apart, fabs(t->force[i] - t->force[n + i]));
  if (!(apart > t->apart)) return apart;
  t->apart = apart;
  t->time = now;
  t->h = s->made.h;
  return apart;
}

/* The largest difference, when what comes later has shown how large forces are. */
static slave_status judge(slave *s, const ali3_report *r) {
  slave_half_steps *t = &s->half_steps;
  const double n = (double)parts_of(t->h), order_2 = n * n / (n * n - 1.0);
  const double off = order_2 * t->apart, error = off / t->largest, h = t->h;
  t->apart = 0.0;
  if (!(error > WRONG)) return SLAVE_OK;
  if (slave_event_told(r)) return slave_say_event(s, r);
  s->event_said = true;
  return slave_say(
      s, SLAVE_WARNING,
      "At %.4g s a tyre, a contact or a stop had changed a force too quickly for the step: made again with "
      "1/%.0f of it, forces are off by about %.0f N, %.2g %% of the largest at communication points. Run again "
      "with a step_size of %.2g s. This is said once.",
      t->time, n, off, 100.0 * error, h * fmin(0.5, SAFE * WRONG / error));
}

/* What can be said by now, or when the run has `ended`. */
static slave_status tell(slave *s, const ali3_report *r, double now, bool ended) {
  const slave_half_steps *t = &s->half_steps;
  const bool told = slave_event_told(r);
  slave_status status = SLAVE_OK;
  if (t->apart > 0.0 && (ended || told || now > t->time + LATER)) status = judge(s, r);
  if (s->event_said || !t->alone || !told || (t->left > 0.0 && !ended)) return status;
  return slave_say_event(s, r);
}

/* What is not judged when the run ends. */
void slave_half_steps_end(slave *s) {
  ali3_report report;
  if (!s->event_said && ali3_report_get(s->fidelity.kernel, &report) == ALI3_OK) tell(s, &report, 0.0, true);
}

/* After a good communication step whose start the fidelity keeps; before slopes are forgotten. */
slave_status slave_halve_steps(slave *s) {
  slave_half_steps *t = &s->half_steps;
  ali3_report report;
  if (s->event_said || ali3_report_get(s->fidelity.kernel, &report) != ALI3_OK) return SLAVE_OK;
  /* tyres that are driven from the start on slip at once, where long steps miss it */
  const bool begins = t->begins && parts_of(s->made.h) == MOST && ali3_contact_forces(s->fidelity.kernel, 1, NULL) > 0,
             abrupt = report.abrupt_steps > t->abrupt || begins, rests = !(t->left > 0.0);
  const double length = (double)s->made.n * s->made.h, now = ali3_time(s->fidelity.kernel);
  t->abrupt = report.abrupt_steps;
  t->begins = false;
  if (begins && !(t->driven > 0.0)) t->spent = -START; /* beside what abrupt forces may cost */
  t->driven += length;
  t->largest = fmax(t->largest, ali3_largest_contact_force(s->fidelity.kernel));
  const bool spent = t->spent > FREE + SHARE * t->driven;
  if (abrupt && (spent || !allocate(s))) {
    t->alone = true;
  } else if (abrupt) {
    if (rests) memcpy(t->other, s->fidelity.start, ali3_snapshot_size(s->fidelity.system));
    t->jumped = t->jumped && !rests;
    t->alone = t->alone && !rests;
    t->left = fmax(t->left, begins ? START : SPAN);
  }
  if (t->left > 0.0) {
    t->left -= length;
    t->spent += length;
    if (follow(s, now) > AGREED * WRONG * t->largest && !spent) t->left = fmax(t->left, SPAN);
  }
  return tell(s, &report, now, false);
}
