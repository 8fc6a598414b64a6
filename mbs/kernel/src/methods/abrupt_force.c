/* Forces of tyres, contacts and springs with end stops that change abruptly in a step: it is made in halves, so that a
 * run and its refinement divide the same stretches. */
#include "abrupt_force.h"

#include <math.h>

#include "../elements/element.h"

static const double ABRUPT = 0.1; /* of the largest force: a change in a step */
/* 1/s, times the step that is asked for: of the largest force, a change in a part that halves it, where that is less
 * than ABRUPT. So the parts shrink with the step: of stops below 2 ms, of contacts below 20 ms. Measured in
 * docs/theory.md. */
static const double STOP_RATE = 50.0, CONTACT_RATE = 5.0;
enum { DIVISIONS = 2 }; /* how deep a step is halved at such a change */
enum { ENOUGH = 4 }; /* iterations of a half that is made without trying the whole, where they are limited */

/* The larger one, of one instruction; a NaN in x counts as nothing. */
static double more(double most, double x) { return x > most ? x : most; }

/* The largest of a contact's forces and of `most`. */
static double larger(const ali3_contact_forces_of *contact, const double *out, double most) {
  for (int32_t i = contact->n; i-- > 0;) most = more(most, fabs(out[contact->first + i]));
  return most;
}

/* Largest change of a contact's judged forces in a step between two of its ends; *largest: of these forces. */
static double change_of(const ali3_contact_forces_of *contact, const double *from, const double *to, double *largest) {
  double most = 0.0;
  for (int32_t i = contact->judged + contact->n_judged; i-- > contact->judged;) {
    most = more(most, fabs(to[i] - from[i]));
    *largest = more(more(*largest, fabs(from[i])), fabs(to[i]));
  }
  return most;
}

/* Whether a step that may be halved so deep is, where a force changes abruptly in it. */
static bool may_divide(const ali3_instance *in, int32_t depth) {
  return depth > 0 && depth > in->settings.max_halvings - DIVISIONS && in->system->nr > 0;
}

bool ali3_leaves_parts(ali3_instance *in, const ali3_request *request, int32_t iterations) {
  const int64_t left = request->iterations_end - in->report.iterations;
  if (in->settings.step_iterations > 0 && left < 2 * (int64_t)iterations) {
    in->bound.capped = true;
    return false;
  }
  in->report.divisions++;
  return true;
}

/* The change from which on parts of the present step are halved. */
static double most_change(const ali3_instance *in, double rate) { return fmin(rate * in->inputs.whole_length, ABRUPT); }

/* Whether a part with such a report.change_rate is made in halves. Its parts may change less; who judges
 * abrupt steps afterwards is told of the whole. */
static bool divided(ali3_instance *in, const ali3_request *part, int32_t iterations) {
  if (!(may_divide(in, part->depth) && in->report.change_rate * part->h > 1.0)) return false;
  if (!ali3_leaves_parts(in, part, iterations)) return false;
  in->report.abrupt_steps++;
  return true;
}

bool ali3_divides_ahead(ali3_instance *in, const ali3_request *request) { return divided(in, request, ENOUGH); }

/* A change over the largest one that is not divided; where nothing changes there may be no force. */
static double over(double change, double largest) { return change > 0.0 ? change / largest : 0.0; }

/* A load is measured by the largest load there was, other forces by the largest force. */
bool ali3_divides(ali3_instance *in, const ali3_request *request) {
  const ali3_system *S = in->system;
  if (S->nr == 0) return false;
  enum { STOP, CONTACT, TYRE, KINDS };
  double most[KINDS] = {0.0}, largest_load = in->report.largest_load, largest_force = in->report.largest_force;
  for (int32_t c = 0; c < S->n_contact; c++) {
    const ali3_contact_forces_of *contact = S->contact + c;
    const int32_t kind = contact->tyre ? TYRE : contact->touches ? CONTACT : STOP;
    double *largest = kind == TYRE ? &largest_load : &largest_force;
    most[kind] = more(most[kind], change_of(contact, in->now.out, in->next.out, largest));
  }
  in->parting.changed = fmax(fmax(most[TYRE], most[CONTACT]), most[STOP]);
  largest_force = fmax(largest_force, largest_load);
  const double load = over(most[TYRE], ABRUPT * largest_load),
               force = over(most[CONTACT], most_change(in, CONTACT_RATE) * largest_force),
               stop = over(most[STOP], most_change(in, STOP_RATE) * largest_force);
  in->report.change_rate = fmax(fmax(load, force), stop) / request->h;
  return divided(in, request, in->report.last_iterations);
}

/* Whether a spring lies beyond a stop at the begin or the end of the step. */
static bool beyond(const ali3_instance *in, const ali3_contact_forces_of *contact) {
  const ali3_system *S = in->system;
  const ali3_element_size *at = S->el_size + contact->element;
  const ali3_element_type *kind = S->el_kind[contact->element];
  return kind->stops(in->parameters.el_real + at->real, in->next.out + at->out) ||
         kind->stops(in->parameters.el_real + at->real, in->now.out + at->out);
}

/* Largest change of a judged force in the step; without roads of springs beyond their stops alone. */
static double changed(const ali3_instance *in) {
  double most = 0.0, largest = 0.0;
  for (int32_t c = 0; c < in->system->n_contact; c++)
    if (in->system->nr > 0 || beyond(in, in->system->contact + c))
      most = more(most, change_of(in->system->contact + c, in->next.out, in->now.out, &largest));
  return most;
}

/* After a step from in->next to in->now. */
void ali3_abrupt_force(ali3_instance *in) {
  ali3_report *r = &in->report;
  for (int32_t c = 0; c < in->system->n_contact; c++) {
    const ali3_contact_forces_of *contact = in->system->contact + c;
    r->largest_force = larger(contact, in->now.out, r->largest_force);
    if (contact->tyre) /* the start has no step before it */
      r->largest_load = more(more(r->largest_load, in->next.out[contact->judged]), in->now.out[contact->judged]);
  }
  if ((in->parting.changed < 0.0 ? changed(in) : in->parting.changed) > ABRUPT * r->largest_force) r->abrupt_steps++;
}
