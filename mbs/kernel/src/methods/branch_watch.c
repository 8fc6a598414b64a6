/* Checks the assembly modes of closed loops after each step and reports a change.
 *
 * Left: a loop is in none of its modes, as after a dead centre that it was not meant to reach.
 * Jump: where all arms of a ring lie nearly in line branches cross, or nearly. A step there in which a triad changes
 * its sign is repeated in 4 parts, up to that behind which it has changed, and, where these do not change it, in 8:
 * where these agree with each other and not with it, the step has jumped. On the smooth branch all three agree. The
 * state and what the step left behind are those of the whole step. */
#include <math.h>
#include <string.h>

#include "../algebra/number_pairs.h"
#include "../instance.h"
#include "../method.h"
#include "../rows/assembly_mode.h"
#include "../state/inputs.h"
#include "../state/vectors.h"
#include "branch_watch.h"
#include "energy_balance.h"
#include "error_control.h"
#include "steps.h"

static const double IN_LINE = 0.25; /* square of the largest sine of a ring whose branches may be near */
static const double APART = 0.5; /* of the change in the step: the parts come out elsewhere; of that: they agree */
static const double MOST_TURNED = 0.2; /* sine of a ring in a controlled step past a place where branches may be near */
static const double SAFE = 0.65, APART_AGAIN = 0.25; /* of MOST_TURNED; of a step that ends elsewhere than its parts */
enum { FEW = 4, MANY = 8, LOOKS = 8 };

enum { RING = 10, ITEMS = ALI3_TRIAD_ITEMS };

static double root(double signed_square) { return signed_square < 0.0 ? -sqrt(-signed_square) : sqrt(signed_square); }

static bool watches(const ali3_instance *in) { return in->system->n_mode_triad > 0; }

static bool same_ring(const ali3_instance *in, int32_t j, int32_t k) {
  const int32_t *ring = in->system->mode_triad + RING;
  return ring[ITEMS * j] == ring[ITEMS * k];
}

/* Whether triad k and all others of its ring, at least one, are nearly in line. */
static bool in_line(const ali3_instance *in, const double *sine, int32_t k, int32_t first, int32_t end) {
  int32_t n = 0;
  if (!(fabs(sine[k]) < IN_LINE)) return false;
  for (int32_t j = first; j < end; j++) {
    if (!same_ring(in, j, k)) continue;
    if (!(fabs(sine[j]) < IN_LINE)) return false;
    n++;
  }
  return n > 1;
}

static void look(ali3_instance *in) {
  ali3_mode_angles(in, in->now.q);
  for (int64_t loop = 0; loop < ali3_loop_count(in->system); loop++)
    in->branch.left[loop] = ali3_mode_left(in, loop) >= 0 ? 1.0 : 0.0;
}

static void report(ali3_instance *in, int64_t loop, int32_t triad, int32_t kind, double t) {
  ali3_report *r = &in->report;
  if (r->branch_changes++ > 0) return; /* only the first is reported */
  r->branch_loop = (int32_t)loop;
  r->branch_triad = triad;
  r->branch_kind = kind;
  r->branch_time = t;
}

/* Before a step: the angles it starts from, and the whole state where branches may be near. */
void ali3_branch_before(ali3_instance *in) {
  const ali3_system *S = in->system;
  in->branch.near = false;
  if (!watches(in)) return;
  if (!in->branch.known) look(in);
  in->branch.known = true;
  ali3_copy(in->branch.sine_before, in->branch.sine, ali3_triad_count(S));
  if (ali3_method_of(in)->relative) return; /* its state is not always that of the last step */
  for (int64_t loop = 0; loop < ali3_loop_count(S) && !in->branch.near; loop++) {
    const int32_t first = S->mode_triad_ptr[loop] / ITEMS, end = S->mode_triad_ptr[loop + 1] / ITEMS;
    for (int32_t k = first; k < end && !in->branch.near; k++)
      in->branch.near = in_line(in, in->branch.sine, k, first, end);
  }
  if (!in->branch.near) return;
  ali3_vectors_copy(in, &in->kept.near_branch, &in->now);
  in->branch.report_before = in->report;
}

/* Back to before the step, with the energy balance that goes with it: it takes part in the judgement of a step. */
static void again(ali3_instance *in) {
  ali3_vectors_copy(in, &in->now, &in->kept.near_branch);
  in->report = in->branch.report_before;
  in->clock.now = ali3_time(in); /* that of the last whole step */
}

/* Whether a step made triad k of a loop with the triads first to end change its sign where branches may be near. */
static bool crossed(const ali3_instance *in, int32_t k, int32_t first, int32_t end) {
  return in->branch.sine_before[k] * in->branch.sine_after[k] < 0.0 &&
         in_line(in, in->branch.sine_before, k, first, end) && in_line(in, in->branch.sine_after, k, first, end);
}

/* Whether every triad of those that the step made change its sign, where branches may be near, changed it in the angles
 * of now too. */
static bool all_crossed(const ali3_instance *in, int32_t first, int32_t end) {
  for (int32_t k = first; k < end; k++)
    if (crossed(in, k, first, end) && !(in->branch.sine[k] * in->branch.sine_after[k] > 0.0)) return false;
  return true;
}

/* The step from in->kept.near_branch in n equal parts, the angles at its end, or at that of the first part behind which
 * all triads from first to end have crossed; false where a part fails. */
static bool in_parts(ali3_instance *in, const ali3_request *step, int n, int32_t first, int32_t end) {
  ali3_request part = *step;
  part.h = step->h / n;
  part.depth = 0;
  again(in);
  for (int i = 1; i <= n; i++) {
    in->kept.backed_up = false;
    part.t = step->t - step->h + step->h * (double)i / n;
    if (ali3_advance(in, &part) != ALI3_OK) return false;
    ali3_mode_angles(in, in->now.q);
    if (all_crossed(in, first, end)) return true;
  }
  return true;
}

/* Whether parts of the step, with these sines at their end, keep the sign of triad k that the whole changed. */
static bool keeps(const ali3_instance *in, const double *sine, int32_t k, int32_t first, int32_t end) {
  return crossed(in, k, first, end) && root(sine[k]) * root(in->branch.sine_after[k]) < 0.0;
}

/* The first triad, counted in its loop, whose sign the step changed otherwise than its parts do, or -1. */
static int32_t jumped(ali3_instance *in, const ali3_request *step, int32_t first, int32_t end) {
  const size_t all = (size_t)ali3_triad_count(in->system) * sizeof(double);
  if (!in_parts(in, step, FEW, first, end)) return -1;
  memcpy(in->branch.sine_few, in->branch.sine, all);
  int32_t k = first;
  while (k < end && !keeps(in, in->branch.sine_few, k, first, end)) k++;
  if (k == end || !in_parts(in, step, MANY, first, end)) return -1;
  for (; k < end; k++) {
    const double before = root(in->branch.sine_before[k]), after = root(in->branch.sine_after[k]),
                 few = root(in->branch.sine_few[k]), many = root(in->branch.sine[k]), apart = fabs(many - after);
    if (keeps(in, in->branch.sine_few, k, first, end) && keeps(in, in->branch.sine, k, first, end) &&
        apart > APART * fabs(after - before) && fabs(many - few) < APART * apart)
      return k - first;
  }
  return -1;
}

/* Repeats in parts a step in which a triad of the loop changed its sign; then its end comes back, by the whole step once
 * more where a reader will use its work space. */
static ali3_status judge(ali3_instance *in, const ali3_request *step, int64_t loop) {
  const ali3_system *S = in->system;
  const int32_t first = S->mode_triad_ptr[loop] / ITEMS, end = S->mode_triad_ptr[loop + 1] / ITEMS;
  int32_t k = first;
  while (k < end && !crossed(in, k, first, end)) k++;
  if (k == end) return ALI3_OK;
  const ali3_report whole = in->report;
  const bool read = step->reading != ALI3_READ_NOTHING;
  if (!read) ali3_vectors_copy(in, &in->kept.coarse, &in->now);
  const int32_t triad = jumped(in, step, first, end);
  ali3_status status;
  if (!read) {
    ali3_vectors_copy(in, &in->now, &in->kept.coarse);
    in->clock.now = ali3_time(in);
    status = ali3_inputs_begin(in, step->t, step->h);
    in->clock.now = step->t;
  } else {
    again(in);
    in->kept.backed_up = false;
    status = ali3_advance(in, step);
  }
  in->report = whole;
  if (status == ALI3_OK && triad >= 0) report(in, loop, triad, ALI3_BRANCH_JUMP, step->t);
  return status;
}

/* Reports the loops that have left their modes at time t. */
static void left_modes(ali3_instance *in, double t) {
  ali3_mode_angles(in, in->now.q);
  for (int64_t loop = 0; loop < ali3_loop_count(in->system); loop++) {
    const int32_t left = ali3_mode_left(in, loop);
    if (left >= 0 && in->branch.left[loop] == 0.0) report(in, loop, left, ALI3_BRANCH_LEFT, t);
    in->branch.left[loop] = left >= 0 ? 1.0 : 0.0;
  }
}

/* Turn of a ring that is nearly in line where one of its triads changes its sign during the controlled step: the
 * largest change of a sine of the ring, 0 where none does. Folded arms change their sign by interpolation alone, or
 * turn little while the other joint of the ring passes to the other branch. *look: the eighth of the step in which the
 * sign changes, from 1 on. */
static double passed(ali3_instance *in, double h, int *look) {
  const ali3_system *S = in->system;
  const size_t all = (size_t)ali3_triad_count(S) * sizeof(double);
  int32_t found = -1, first = 0, end = 0;
  ali3_mode_angles(in, in->kept.origin.q);
  memcpy(in->branch.sine_few, in->branch.sine, all);
  for (int n = 1; n <= LOOKS && found < 0; n++) {
    memcpy(in->branch.sine_before, in->branch.sine, all);
    ali3_interpolate(in, h, 2.0 * n / LOOKS - 1.0, &in->next);
    ali3_mode_angles(in, in->next.q);
    for (int64_t loop = 0; loop < ali3_loop_count(S) && found < 0; loop++) {
      first = S->mode_triad_ptr[loop] / ITEMS;
      end = S->mode_triad_ptr[loop + 1] / ITEMS;
      for (int32_t k = first; k < end && found < 0; k++)
        if (in->branch.sine_before[k] * in->branch.sine[k] < 0.0 &&
            (in_line(in, in->branch.sine_before, k, first, end) || in_line(in, in->branch.sine, k, first, end)))
          found = k;
    }
    *look = n;
  }
  if (found < 0) return 0.0;
  ali3_mode_angles(in, in->now.q);
  double turned = 1e-300;
  for (int32_t k = first; k < end; k++)
    if (same_ring(in, k, found)) turned = fmax(turned, fabs(root(in->branch.sine[k]) - root(in->branch.sine_few[k])));
  return turned;
}

/* Whether the accepted step of in->kept.origin, in->kept.centre and in->now may have jumped where branches are near: it
 * turns a ring too far to know, or ends elsewhere than in shorter parts. The whole and its halves may have jumped
 * alike. Returns the share of the step that may be made: one that turns the ring as far as it may, or ends before it is
 * in line; 1: all of it. */
double ali3_branch_share(ali3_instance *in, const ali3_measure *measure, double t, double h) {
  const int32_t nq = in->system->size.nq;
  int look = 0;
  if (!watches(in)) return 1.0;
  const double turned = passed(in, h, &look);
  if (turned == 0.0) return 1.0;
  if (turned > MOST_TURNED) {
    const double far_enough = SAFE * MOST_TURNED / turned;
    return far_enough * LOOKS > look ? far_enough : fmax(far_enough, (look - 1.0) / LOOKS);
  }
  const ali3_report whole = in->report;
  ali3_vectors_copy(in, &in->kept.coarse, &in->now);
  ali3_vectors_copy(in, &in->now, &in->kept.origin);
  ali3_status status = ALI3_OK;
  for (int i = 0; i < MANY && status == ALI3_OK; i++)
    status = ali3_trial_step(in, t + h * (double)i / MANY, h / MANY, ALI3_READ_SENSORS);
  for (int32_t i = 0; i < nq; i++) {
    in->step.w[i] = in->now.q[i] - in->kept.coarse.q[i];
    in->step.x[i] = 0.0;
  }
  const bool apart =
      status == ALI3_OK && ali3_distance(in, measure, in->step.w, in->step.x, 1.0) > measure->control->tolerance;
  ali3_vectors_copy(in, &in->now, &in->kept.coarse);
  in->bound.iterations_before = whole.iterations;
  ali3_balance_restore(&in->report, &whole);
  in->clock.now = t + h;
  return apart ? APART_AGAIN : 1.0;
}

/* After a controlled step, whose halves have shown already that no other branch is near enough to be jumped to. */
void ali3_branch_look(ali3_instance *in, double t) {
  if (watches(in)) left_modes(in, t);
}

/* After a good step. */
ali3_status ali3_branch_after(ali3_instance *in, const ali3_request *step) {
  const ali3_system *S = in->system;
  const size_t all = (size_t)ali3_triad_count(S) * sizeof(double);
  if (!watches(in)) return ALI3_OK;
  if (ali3_method_of(in)->relative && step->reading == ALI3_READ_NOTHING) {
    in->branch.known = false;
    return ALI3_OK;
  }
  left_modes(in, step->t);
  /* with a limit of the work of a step none is repeated: a jump is then told where its loop has left its mode */
  if (!in->branch.near || in->settings.step_iterations > 0) return ALI3_OK;
  memcpy(in->branch.sine_after, in->branch.sine, all);
  ali3_status status = ALI3_OK;
  for (int64_t loop = 0; loop < ali3_loop_count(S) && status == ALI3_OK; loop++) status = judge(in, step, loop);
  memcpy(in->branch.sine, in->branch.sine_after, all);
  return status;
}
