/* Checks the assembly modes of closed loops after each step and reports changes.
 *
 * Left: a loop has left all its modes, for example after a dead centre.
 * Jump: where all arms of a cycle are nearly aligned, branches of the solution are close to each other. A step there in
 * which a triad changes its sign is repeated in 4 parts, up to the part in which it has changed, and, if they do not
 * change it, in 8: if both agree with each other but not with the step, the step has jumped to another branch. On a
 * smooth branch all three agree. The state and the work arrays after the check belong to the undivided step. */
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

static const double ALIGNED_SINE = 0.25; /* squared sine of the angles of a cycle below which branches may be close */
static const double DIFFERENT = 0.5; /* a larger fraction of the change of a sine is a difference between branches */
static const double MAX_TURN = 0.2; /* largest change of a sine in a controlled step near other branches */
static const double SAFETY = 0.65, AFTER_JUMP = 0.25; /* factors of the step after a large turn, after a jump */
enum { FEW = 4, MANY = 8, SAMPLES = 8 };

enum { CYCLE = 10, ITEMS = ALI3_TRIAD_ITEMS };

/* Root of |x| with the sign of x. */
static double signed_root(double signed_square) {
  return signed_square < 0.0 ? -sqrt(-signed_square) : sqrt(signed_square);
}

static bool has_modes(const ali3_instance *in) { return in->system->n_mode_triad > 0; }

/* Whether triads j and k belong to the same cycle. */
static bool same_cycle(const ali3_instance *in, int32_t j, int32_t k) {
  const int32_t *cycle = in->system->mode_triad + CYCLE;
  return cycle[ITEMS * j] == cycle[ITEMS * k];
}

/* Whether triad k and all others of its cycle, at least one, are nearly aligned. */
static bool is_aligned(const ali3_instance *in, const double *sine, int32_t k, int32_t first, int32_t end) {
  int32_t n = 0;
  if (!(fabs(sine[k]) < ALIGNED_SINE)) return false;
  for (int32_t j = first; j < end; j++) {
    if (!same_cycle(in, j, k)) continue;
    if (!(fabs(sine[j]) < ALIGNED_SINE)) return false;
    n++;
  }
  return n > 1;
}

/* Stores for each loop whether it has left its assembly mode. */
static void update_modes(ali3_instance *in) {
  ali3_mode_angles(in, in->now.q);
  for (int64_t loop = 0; loop < ali3_loop_count(in->system); loop++)
    in->branch.left[loop] = ali3_find_mode_misfit(in, loop) >= 0 ? 1.0 : 0.0;
}

/* Records the first change of an assembly mode, at t, s. */
static void record_change(ali3_instance *in, int64_t loop, int32_t triad, int32_t kind, double t) {
  ali3_report *r = &in->report;
  if (r->branch_changes++ > 0) return; /* only the first is reported */
  r->branch_loop = (int32_t)loop;
  r->branch_triad = triad;
  r->branch_kind = kind;
  r->branch_time = t;
}

void ali3_branch_before(ali3_instance *in) {
  const ali3_system *S = in->system;
  in->branch.near = false;
  if (!has_modes(in)) return;
  if (!in->branch.known) update_modes(in);
  in->branch.known = true;
  ali3_copy(in->branch.sine_before, in->branch.sine, ali3_triad_count(S));
  if (ali3_method_of(in)->relative) return; /* in->now may not have the state of the last step */
  for (int64_t loop = 0; loop < ali3_loop_count(S) && !in->branch.near; loop++) {
    const int32_t first = S->mode_triad_ptr[loop] / ITEMS, end = S->mode_triad_ptr[loop + 1] / ITEMS;
    for (int32_t k = first; k < end && !in->branch.near; k++)
      in->branch.near = is_aligned(in, in->branch.sine, k, first, end);
  }
  if (!in->branch.near) return;
  ali3_vectors_copy(in, &in->stored.near_branch, &in->now);
  in->branch.report_before = in->report;
}

/* Restores the state before the step and the energy balance, by which steps are refused. */
static void restore_start(ali3_instance *in) {
  ali3_vectors_copy(in, &in->now, &in->stored.near_branch);
  in->report = in->branch.report_before;
  in->clock.now = ali3_time(in); /* time of the last complete step */
}

/* Whether triad k of a loop with the triads first to end - 1 has changed its sign in the step while its cycle was
 * aligned. */
static bool crossed(const ali3_instance *in, int32_t k, int32_t first, int32_t end) {
  return in->branch.sine_before[k] * in->branch.sine_after[k] < 0.0 &&
         is_aligned(in, in->branch.sine_before, k, first, end) && is_aligned(in, in->branch.sine_after, k, first, end);
}

/* Whether all triads that have changed their sign in the step have changed it at the present angles too. */
static bool all_crossed(const ali3_instance *in, int32_t first, int32_t end) {
  for (int32_t k = first; k < end; k++)
    if (crossed(in, k, first, end) && !(in->branch.sine[k] * in->branch.sine_after[k] > 0.0)) return false;
  return true;
}

/* Repeats the step from in->stored.near_branch in n equal parts, up to the first one after which all triads from first
 * to end - 1 have changed their sign; false: a part failed. */
static bool divide_step(ali3_instance *in, const ali3_request *step, int n, int32_t first, int32_t end) {
  ali3_request part = *step;
  part.h = step->h / n;
  part.depth = 0;
  restore_start(in);
  for (int i = 1; i <= n; i++) {
    in->stored.backed_up = false;
    part.t = step->t - step->h + step->h * (double)i / n;
    if (ali3_advance(in, &part) != ALI3_OK) return false;
    ali3_mode_angles(in, in->now.q);
    if (all_crossed(in, first, end)) return true;
  }
  return true;
}

/* Whether triad k, which changed its sign in the step, has not changed it in the parts, after which the sines are
 * `sine`. */
static bool keeps_sign(const ali3_instance *in, const double *sine, int32_t k, int32_t first, int32_t end) {
  return crossed(in, k, first, end) && signed_root(sine[k]) * signed_root(in->branch.sine_after[k]) < 0.0;
}

/* First triad, as an index in its loop, that changed its sign in the step but not in its parts; -1: none. */
static int32_t jumped_triad(ali3_instance *in, const ali3_request *step, int32_t first, int32_t end) {
  const size_t size = (size_t)ali3_triad_count(in->system) * sizeof(double);
  if (!divide_step(in, step, FEW, first, end)) return -1;
  memcpy(in->branch.sine_few, in->branch.sine, size);
  int32_t k = first;
  while (k < end && !keeps_sign(in, in->branch.sine_few, k, first, end)) k++;
  if (k == end || !divide_step(in, step, MANY, first, end)) return -1;
  for (; k < end; k++) {
    const double before = signed_root(in->branch.sine_before[k]), after = signed_root(in->branch.sine_after[k]),
                 few = signed_root(in->branch.sine_few[k]), many = signed_root(in->branch.sine[k]),
                 difference = fabs(many - after);
    if (keeps_sign(in, in->branch.sine_few, k, first, end) && keeps_sign(in, in->branch.sine, k, first, end) &&
        difference > DIFFERENT * fabs(after - before) && fabs(many - few) < DIFFERENT * difference)
      return k - first;
  }
  return -1;
}

/* Repeats in parts a step in which a triad of the loop changed its sign and reports a jump. Then restores the end of
 * the step, by the step itself where its work arrays are read. */
static ali3_status check_jump(ali3_instance *in, const ali3_request *step, int64_t loop) {
  const ali3_system *S = in->system;
  const int32_t first = S->mode_triad_ptr[loop] / ITEMS, end = S->mode_triad_ptr[loop + 1] / ITEMS;
  int32_t k = first;
  while (k < end && !crossed(in, k, first, end)) k++;
  if (k == end) return ALI3_OK;
  const ali3_report whole = in->report;
  const bool is_read = step->reading != ALI3_READ_NOTHING;
  if (!is_read) ali3_vectors_copy(in, &in->stored.coarse, &in->now);
  const int32_t triad = jumped_triad(in, step, first, end);
  ali3_status status;
  if (!is_read) {
    ali3_vectors_copy(in, &in->now, &in->stored.coarse);
    in->clock.now = ali3_time(in);
    status = ali3_inputs_begin(in, step->t, step->h);
    in->clock.now = step->t;
  } else {
    restore_start(in);
    in->stored.backed_up = false;
    status = ali3_advance(in, step);
  }
  in->report = whole;
  if (status == ALI3_OK && triad >= 0) record_change(in, loop, triad, ALI3_BRANCH_JUMP, step->t);
  return status;
}

/* Reports the loops that have left their modes at time t. */
static void report_left_modes(ali3_instance *in, double t) {
  ali3_mode_angles(in, in->now.q);
  for (int64_t loop = 0; loop < ali3_loop_count(in->system); loop++) {
    const int32_t left_triad = ali3_find_mode_misfit(in, loop);
    if (left_triad >= 0 && in->branch.left[loop] == 0.0) record_change(in, loop, left_triad, ALI3_BRANCH_LEFT, t);
    in->branch.left[loop] = left_triad >= 0 ? 1.0 : 0.0;
  }
}

/* Largest change of a sine in an aligned cycle of which a triad changes its sign in the controlled step, 0: there is
 * none. Signs at samples within the step are interpolated, as folded arms may turn little while another joint of the
 * cycle changes its branch. *sample: number of the sample, the first is 1, at which the sign changes. */
static double cycle_turn(ali3_instance *in, double h, int *sample) {
  const ali3_system *S = in->system;
  const size_t size = (size_t)ali3_triad_count(S) * sizeof(double);
  int32_t triad = -1, first = 0, end = 0;
  ali3_mode_angles(in, in->stored.origin.q);
  memcpy(in->branch.sine_few, in->branch.sine, size);
  for (int n = 1; n <= SAMPLES && triad < 0; n++) {
    memcpy(in->branch.sine_before, in->branch.sine, size);
    ali3_interpolate(in, h, 2.0 * n / SAMPLES - 1.0, &in->next);
    ali3_mode_angles(in, in->next.q);
    for (int64_t loop = 0; loop < ali3_loop_count(S) && triad < 0; loop++) {
      first = S->mode_triad_ptr[loop] / ITEMS;
      end = S->mode_triad_ptr[loop + 1] / ITEMS;
      for (int32_t k = first; k < end && triad < 0; k++)
        if (in->branch.sine_before[k] * in->branch.sine[k] < 0.0 &&
            (is_aligned(in, in->branch.sine_before, k, first, end) || is_aligned(in, in->branch.sine, k, first, end)))
          triad = k;
    }
    *sample = n;
  }
  if (triad < 0) return 0.0;
  ali3_mode_angles(in, in->now.q);
  double turn = 1e-300;
  for (int32_t k = first; k < end; k++)
    if (same_cycle(in, k, triad))
      turn = fmax(turn, fabs(signed_root(in->branch.sine[k]) - signed_root(in->branch.sine_few[k])));
  return turn;
}

/* Checks the accepted controlled step of in->stored.origin, in->stored.centre and in->now for a jump between close
 * branches: it turns a cycle too far, or MANY shorter steps end elsewhere; the step and its halves may have jumped in
 * the same way. Returns the fraction of the step that may be made, 1: all. */
double ali3_branch_fraction(ali3_instance *in, const ali3_measure *measure, double t, double h) {
  const int32_t nq = in->system->size.nq;
  int sample = 0;
  if (!has_modes(in)) return 1.0;
  const double turn = cycle_turn(in, h, &sample);
  if (turn == 0.0) return 1.0;
  if (turn > MAX_TURN) {
    const double fraction = SAFETY * MAX_TURN / turn;
    return fraction * SAMPLES > sample ? fraction : fmax(fraction, (sample - 1.0) / SAMPLES);
  }
  const ali3_report whole = in->report;
  ali3_vectors_copy(in, &in->stored.coarse, &in->now);
  ali3_vectors_copy(in, &in->now, &in->stored.origin);
  ali3_status status = ALI3_OK;
  for (int i = 0; i < MANY && status == ALI3_OK; i++)
    status = ali3_trial_step(in, t + h * (double)i / MANY, h / MANY, ALI3_READ_SENSORS);
  for (int32_t i = 0; i < nq; i++) {
    in->step.w[i] = in->now.q[i] - in->stored.coarse.q[i];
    in->step.x[i] = 0.0;
  }
  const bool jumped =
      status == ALI3_OK && ali3_distance(in, measure, in->step.w, in->step.x, 1.0) > measure->control->tolerance;
  ali3_vectors_copy(in, &in->now, &in->stored.coarse);
  in->bound.iterations_before = whole.iterations;
  ali3_balance_restore(&in->report, &whole);
  in->clock.now = t + h;
  return jumped ? AFTER_JUMP : 1.0;
}

void ali3_branch_check(ali3_instance *in, double t) {
  if (has_modes(in)) report_left_modes(in, t);
}

ali3_status ali3_branch_after(ali3_instance *in, const ali3_request *request) {
  const ali3_system *S = in->system;
  const size_t size = (size_t)ali3_triad_count(S) * sizeof(double);
  if (!has_modes(in)) return ALI3_OK;
  if (ali3_method_of(in)->relative && request->reading == ALI3_READ_NOTHING) {
    in->branch.known = false;
    return ALI3_OK;
  }
  report_left_modes(in, request->t);
  /* with a limit of iterations no step is repeated; a jump is reported only if its loop has left its mode */
  if (!in->branch.near || in->settings.step_iterations > 0) return ALI3_OK;
  memcpy(in->branch.sine_after, in->branch.sine, size);
  ali3_status status = ALI3_OK;
  for (int64_t loop = 0; loop < ali3_loop_count(S) && status == ALI3_OK; loop++) status = check_jump(in, request, loop);
  memcpy(in->branch.sine, in->branch.sine_after, size);
  return status;
}
