/* Location of contact events: a step in which an end stop is met or left is divided at that time. The force has a kink
 * there, whose error by the trapezoidal rule depends on its position in the step, so that errors of two step sizes
 * would not be comparable. The time is located in the last trial step, and again in its parts. So are rows of a force
 * by table that the step passed by its acceleration, which no rate at its start shows. */
#include "contact_event.h"

#include <math.h>

#include "../elements/crossing.h"
#include "../elements/element.h"
#include "abrupt_force.h"

enum { MAX_EVENTS = 4 }; /* in a requested step */

void ali3_events_begin(ali3_instance *in, int32_t depth) {
  in->parting.events_left = depth > 0 && in->system->nr == 0 ? MAX_EVENTS : -1;
}

/* Share of a step of h at which the length of a force by table is at the first row that its ends do not resolve, from
 * the outputs (length, force, rate) at both ends; 1 if they resolve all. */
static double row_passed(const ali3_instance *in, int32_t element, const double *from, const double *to, double h) {
  const double way = ali3_table_resolved(in, element, from[0], to[0]), row = from[0] + way * (to[0] - from[0]);
  if (way == 1.0) return 1.0;
  return ali3_crossing(h, (double[]){from[0] - row, to[0] - row}, (double[]){from[2], to[2]});
}

/* Share of a step of h from the outputs `from` to `to` at which the first element reports an event; 1: none does. */
static double first_event(const ali3_instance *in, const double *from, const double *to, double h) {
  const ali3_system *S = in->system;
  double first = 1.0;
  for (int32_t c = 0; c < S->n_contact; c++) {
    const int32_t e = S->contact[c].element;
    const ali3_element_type *kind = S->el_kind[e];
    const ali3_element_size *at = S->el_size + e;
    if (kind->event != NULL)
      first = fmin(first, kind->event(in->parameters.el_real + at->real, at->nreal, from + at->out, to + at->out, h));
    else if (kind->resolved != NULL)
      first = fmin(first, row_passed(in, e, from + at->out, to + at->out, h));
  }
  return first;
}

bool ali3_meets_event(const ali3_instance *in, const ali3_vectors *from, const ali3_vectors *to, double h) {
  return first_event(in, from->out, to->out, h) < 1.0;
}

bool ali3_contact_event(ali3_instance *in, const ali3_request *request) {
  if (in->parting.events_left < 0) return false;
  const double h = request->h, fraction = first_event(in, in->now.out, in->next.out, h),
               near = ALI3_AT_END * in->inputs.whole_length;
  if (!(fraction * h > near && (1.0 - fraction) * h > near)) return false;
  if (in->parting.events_left == 0) {
    in->report.abrupt_steps++; /* an event that is not located is reported */
    return false;
  }
  if (!ali3_allows_division(in, request, in->report.last_iterations)) return false;
  in->parting.events_left--;
  in->parting.event = fraction;
  return true;
}
