/* A contact with a road, such as an edge at speed, that is too quick for the step: what the steps of a quick change
 * miss of v + h a, from the worst one on, is held against the path that the velocity goes meanwhile. A run that repeats
 * nothing has no better sign of it. */
#include <math.h>

#include "../elements/element.h"
#include "../start/initialise.h"
#include "coarse_event.h"

static const double SPAN = 0.2; /* s, of an event: a wheel on its tyre swings about twice */
static const double COARSE = 0.15; /* of the path; calibrated on random drives of two cars over kerbs and drops */
static const double LEAST = 0.2; /* of what gravity does to the velocities in the span: a smaller change is no event */

static const double UNEVEN = 0.005; /* m: a change of the road's height under a wheel in a step */
static const double QUIET = 1e-3; /* s of fall: what no step need be looked at for */

/* How deep element e is in its road at q; *height: of its first point. */
static double depth_at(const ali3_instance *in, const double *q, int32_t e, double *height) {
  double u[ALI3_MAX_SIGNALS] = {0.0}, part;
  const ali3_element_args a = ali3_start_arguments(in, in->road, q, e, u);
  *height = u[2];
  return in->system->el_kind[e]->depth(&a, 0.0, &part);
}

/* Whether the last step made or lost a contact, or the road under one rose or fell more than the body went. A jump of
 * an input is missed by v + h a alike, and is no such event. */
static bool road_changed(const ali3_instance *in) {
  for (int32_t c = 0; c < in->system->n_contact; c++) {
    const int32_t e = in->system->contact[c].element;
    if (!in->system->contact[c].touches) continue;
    double from, to;
    const double before = depth_at(in, in->next.q, e, &from), now = depth_at(in, in->now.q, e, &to);
    if ((before > 0.0) != (now > 0.0) || (now > 0.0 && fabs(now - before + to - from) > UNEVEN)) return true;
  }
  return false;
}

/* After a step in which the velocity changes by `change` and misses v + h a by `miss`. */
void ali3_coarse_event(ali3_instance *in, double h, double change, double miss) {
  ali3_report *r = &in->report;
  if (miss > r->event_miss && (r->event_miss > 0.0 || miss > QUIET * in->fall) && road_changed(in)) {
    r->event_miss = miss;
    r->event_squares = miss * miss;
    r->event_path = change;
    r->event_left = SPAN;
  } else if (r->event_miss > 0.0) {
    r->event_squares += miss * miss;
    r->event_path += change;
    r->event_left -= h;
  }
  if (r->event_miss == 0.0 || r->event_left >= 0.5 * h) return;
  const double missed = sqrt(r->event_squares), path = r->event_path;
  if (missed > fmax(COARSE, r->coarse_event) * path && path > LEAST * SPAN * in->fall) {
    r->coarse_event = missed / path;
    r->coarse_time = ali3_time(in) - SPAN;
  }
  r->event_miss = r->event_squares = r->event_path = 0.0;
}
