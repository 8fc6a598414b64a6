/* A stop that is met or left within a step: the step is made again up to there and on from there. The force has a kink
 * there, of which the trapezoidal rule misses a share that depends on where in the step it lies, so that errors of two
 * steps would not tell of each other. The time is that of the last trial, and is found again in its parts. */
#include "contact_event.h"

#include <math.h>

#include "../elements/crossing.h"
#include "../elements/element.h"
#include "abrupt_force.h"

enum { EVENTS = 4 }; /* at which a step is divided at most */

/* A step as it is asked for begins, whose parts may be halved so deep. Of cars events cost more than they gain:
 * theory.md. */
void ali3_events_begin(ali3_instance *in, int32_t depth) {
  in->parting.events_left = depth > 0 && in->system->nr == 0 ? EVENTS : -1;
}

/* The first share of the step from in->now to in->next at which an element says so; else 1. */
static double first_event(const ali3_instance *in, double h) {
  const ali3_system *S = in->system;
  double first = 1.0;
  for (int32_t c = 0; c < S->n_contact; c++) {
    const int32_t e = S->contact[c].element;
    const ali3_element_type *kind = S->el_kind[e];
    if (kind->event == NULL) continue;
    const ali3_element_size *at = S->el_size + e;
    first = fmin(first, kind->event(in->parameters.el_real + at->real, at->nreal, in->now.out + at->out,
                                    in->next.out + at->out, h));
  }
  return first;
}

bool ali3_contact_event(ali3_instance *in, const ali3_request *request) {
  if (in->parting.events_left < 0) return false;
  const double h = request->h, share = first_event(in, h), near = ALI3_AT_END * in->inputs.whole_length;
  if (!(share * h > near && (1.0 - share) * h > near)) return false;
  if (in->parting.events_left == 0) {
    in->report.abrupt_steps++; /* one that is not located is told as such */
    return false;
  }
  if (!ali3_leaves_parts(in, request, in->report.last_iterations)) return false;
  in->parting.events_left--;
  in->parting.event = share;
  return true;
}
