/* Location of contact events: a step in which an end stop is met or left is divided at that time. The force has a kink
 * there, whose error depends on its position in the step, so that errors of two step sizes would not be comparable. The
 * time is located in the last trial step, and again in its parts. So are rows of a force by table that the step passed
 * by its acceleration, which no rate at its start shows. */
#include "contact_event.h"

#include <math.h>

#include "../elements/crossing.h"
#include "../elements/element.h"
#include "abrupt_force.h"

enum { MAX_EVENTS = 4 }; /* in a requested step */

void ali3_events_begin(ali3_instance *in, int32_t depth) { in->parting.events_left = depth > 0 ? MAX_EVENTS : -1; }

/* Share of a step of h at which the length of a force by table is at the first row that its ends do not resolve, from
 * the outputs (length, force, rate) at both ends; 1 if they resolve all. */
static double share_to_row(const ali3_instance *in, int32_t element, const double *from, const double *to, double h) {
  const double way = ali3_table_resolved(in, element, from[ALI3_TABLE_LENGTH], to[ALI3_TABLE_LENGTH]);
  const double row = from[ALI3_TABLE_LENGTH] + way * (to[ALI3_TABLE_LENGTH] - from[ALI3_TABLE_LENGTH]);
  if (way == 1.0) return 1.0;
  return ali3_crossing(h, (double[]){from[ALI3_TABLE_LENGTH] - row, to[ALI3_TABLE_LENGTH] - row},
                       (double[]){from[ALI3_TABLE_RATE], to[ALI3_TABLE_RATE]});
}

/* Share of a step of h from the outputs `from` to `to` at which the first element reports an event; 1: none does.
 * `stops`: whether end stops count beside rows of tables; `*at_row`: whether it is a row. */
static double share_to_event(const ali3_instance *in, const double *from, const double *to, double h, bool stops,
                             bool *at_row) {
  const ali3_system *S = in->system;
  double first = 1.0;
  *at_row = false;
  for (int32_t c = 0; c < S->n_contact; c++) {
    const int32_t e = S->contact[c].element;
    const ali3_element_type *kind = S->el_kind[e];
    const ali3_element_size *at = S->el_size + e;
    double share = 1.0;
    if (kind->event != NULL && stops)
      share = kind->event(in->parameters.el_parameter + at->real, at->nreal, from + at->out, to + at->out, h);
    else if (kind->resolved != NULL)
      share = share_to_row(in, e, from + at->out, to + at->out, h);
    if (!(share < first)) continue;
    first = share;
    *at_row = kind->resolved != NULL;
  }
  return first;
}

bool ali3_meets_event(const ali3_instance *in, const ali3_vectors *from, const ali3_vectors *to, double h) {
  bool at_row;
  return share_to_event(in, from->out, to->out, h, true, &at_row) < 1.0;
}

bool ali3_contact_event(ali3_instance *in, const ali3_request *request, const ali3_vectors *from,
                        const ali3_vectors *to) {
  if (in->parting.events_left < 0) return false;
  bool at_row;
  const double h = request->h, fraction = share_to_event(in, from->out, to->out, h, in->system->nr == 0, &at_row),
               near = ALI3_AT_END * in->inputs.whole_length;
  if (!(fraction * h > near && (1.0 - fraction) * h > near)) return false;
  if (in->parting.events_left == 0 || request->depth <= 0) {
    in->report.abrupt_steps++; /* an event that is not located is reported */
    return false;
  }
  if (!ali3_allows_division(in, request, in->report.last_iterations)) return false;
  if (at_row) in->report.abrupt_steps++;
  in->parting.events_left--;
  in->parting.event = fraction;
  return true;
}
