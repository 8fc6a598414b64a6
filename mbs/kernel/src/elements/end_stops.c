/* Forces of bump and rebound stops: at a length, as the mean over a step, and the time of contact. Their tension is
 * F(l - rebound length) - F(bump length - l), each with the loss of its rate, F and loss as in contact_law.h. */
#include "end_stops.h"

#include <math.h>

#include "contact_law.h"
#include "crossing.h"

/* Laws of the bump stop and the rebound stop over the length beyond them. */
static void read_stop_laws(const real *p, int progressive, ali3_contact_law law[2]) {
  const real none = {0};
  for (int side = 0; side < 2; side++) {
    law[side].stiffness = p[side ? ALI3_REBOUND_STIFFNESS : ALI3_BUMP_STIFFNESS];
    law[side].progression = progressive ? p[ALI3_PROGRESSION + side] : none;
    law[side].end = progressive ? p[ALI3_STOP_TRAVEL + side] : none;
    law[side].hard_stiffness =
        progressive ? ali3_where(law[side].stiffness > 0.0, p[ALI3_METAL_STIFFNESS], none) : none;
    law[side].onset = progressive ? p[ALI3_METAL_ONSET] : none;
    law[side].loss = progressive ? p[ALI3_STOP_LOSS + side] : none;
    law[side].restitution = none;
  }
}

void ali3_end_stops_at(const real *p, int progressive, real length, real rate, ali3_tension *t) {
  const real beyond[2] = {p[ALI3_BUMP_LENGTH] - length, length - p[ALI3_REBOUND_LENGTH]};
  for (int side = 0; side < 2; side++) {
    const lane_mask open = ali3_not(beyond[side] > 0.0);
    if (!ali3_any(ali3_not(open))) continue;
    const double sign = side ? 1.0 : -1.0;
    ali3_contact_law law[2];
    read_stop_laws(p, progressive, law);
    real slope = {0}, loss_slope;
    const real force = ali3_contact_force(&law[side], beyond[side], &slope, &t->potential);
    const real factor = ali3_contact_loss(&law[side], sign * rate, &loss_slope);
    ALI3_PIECE(&t->piece, ali3_not(open) & (force > 0.0), 1u << side);
    t->elastic = ali3_add_unless(open, t->elastic, sign * force);
    t->lost = ali3_add_unless(open, t->lost, sign * force * (factor - 1.0));
    t->stiffness = ali3_add_unless(open, t->stiffness, slope * factor);
    t->damping = ali3_add_unless(open, t->damping, force * loss_slope);
  }
}

#ifndef ALI3_WIDTH

/* Adds a stop's difference quotient dV / dl over the step and its slope; x0, x1: the length beyond it, signed. */
static void add_mean(const ali3_contact_law *law, double sign, double x0, double x1, double rate, ali3_tension *t) {
  if (!(x0 > 0.0 || x1 > 0.0)) return;
  double slope = 0.0, energy = 0.0, loss_slope;
  const double mean = ali3_contact_mean(law, x0, x1), factor = ali3_contact_loss(law, sign * rate, &loss_slope);
  const double end = ali3_contact_force(law, x1, &slope, &energy);
  /* twice d(mean)/d(x1): the element's length is the one of the middle */
  if (fabs(x1 - x0) > 1e-6 * (fabs(x0) + fabs(x1))) slope = 2.0 * (end - mean) / (x1 - x0);
  t->elastic += sign * mean * factor;
  t->stiffness += slope * factor;
  t->damping += mean * loss_slope;
}

void ali3_end_stops_between(const double *p, int progressive, double l0, double l1, double rate, ali3_tension *t) {
  const double bump = p[ALI3_BUMP_LENGTH], rebound = p[ALI3_REBOUND_LENGTH];
  ali3_contact_law law[2];
  read_stop_laws(p, progressive, law);
  add_mean(&law[0], -1.0, bump - l0, bump - l1, rate, t);
  add_mean(&law[1], 1.0, l0 - rebound, l1 - rebound, rate, t);
}

double ali3_end_stops_event(const double *p, const double length[2], const double rate[2], double h) {
  double first = 1.0;
  for (int side = ALI3_BUMP_LENGTH; side < ALI3_LINEAR_STOPS; side += ALI3_REBOUND_LENGTH - ALI3_BUMP_LENGTH) {
    const double gap[2] = {length[0] - p[side], length[1] - p[side]};
    if (p[side + 1] > 0.0) first = fmin(first, ali3_crossing(h, gap, rate));
  }
  return first;
}

bool ali3_end_stops_beyond(const double *p, double length) {
  return (p[ALI3_BUMP_STIFFNESS] > 0.0 && length < p[ALI3_BUMP_LENGTH]) ||
         (p[ALI3_REBOUND_STIFFNESS] > 0.0 && length > p[ALI3_REBOUND_LENGTH]);
}

const char *ali3_end_stops_check(const double *p) {
  if (p[ALI3_METAL_STIFFNESS] > 0.0 && !(p[ALI3_METAL_ONSET] > 0.0))
    return "the metal end of a spring's stops needs a depth over which it sets in";
  return 0;
}
#endif
