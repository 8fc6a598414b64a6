/* A wheel that swings on its tyre too quickly for the step, as after an edge: the squares of the change of load in a
 * step, of the tyre where it changes most, summed with a memory, against the largest load. A step of order two is off by
 * h^2 of what the load does; its change in a step is h of it, and the root of a sum over a time goes with 1 / sqrt(h). */
#include "quick_load.h"

#include <math.h>

static const double QUICK = 6e-4; /* s^1.5; calibrated on random drives of five cars over kerbs and drops */
static const double MEMORY = 0.1; /* s, of the sum */
static const double SPAN = 0.2;     /* s after an event in which the largest load comes */
static const double SAFE = 0.3;     /* of the limit: what a step would do with */

/* The event whose span is over, against the largest load up to now. */
static void judge(ali3_report *r) {
  const double found = sqrt(r->load_squares) / r->largest_load;
  if (found > fmax(QUICK, r->quick_load)) {
    if (r->quick_load == 0.0) r->load_time = r->load_begin;
    r->quick_load = found;
    r->load_step = r->load_h * sqrt(SAFE * QUICK / found);
  }
  r->load_squares = 0.0;
}

/* After a step of size h from in->next to in->now. */
void ali3_quick_load(ali3_instance *in, double h) {
  const ali3_system *S = in->system;
  ali3_report *r = &in->report;
  double worst = 0.0;
  for (int32_t c = 0; c < S->n_contact; c++) {
    const ali3_contact_forces_of *contact = S->contact + c;
    if (!contact->tyre) continue;
    const double from = in->next.out[contact->judged], to = in->now.out[contact->judged];
    worst = fmax(worst, fabs(to - from));
    r->largest_load = fmax(r->largest_load, fmax(from, to)); /* the start has no step before it */
  }
  r->load_sum = r->load_sum / (1.0 + h / MEMORY) + h * h * h * worst * worst;
  if (r->load_sum > r->load_squares) {
    r->load_squares = r->load_sum;
    r->load_begin = ali3_time(in);
    r->load_h = h;
    r->load_left = SPAN;
  }
  r->load_left -= h;
  if (r->load_squares > 0.0 && r->load_left < 0.5 * h) judge(r);
}
