/* Abrupt changes of forces of tyres, contacts and springs with end stops: the step is made in halves, so that a run and
 * its refinement divide the same intervals; and the part of a step for which forces by table are resolved. */
#include "abrupt_force.h"

#include <math.h>

#include "../elements/element.h"

static const double ABRUPT = 0.1; /* change of a force in a step, of the largest force */
/* 1/s: change of a force in a part that is halved, of the largest force, over the requested step, if it is less than
 * ABRUPT. So parts decrease with the step: of stops below 2 ms, of tyres below 7 ms, of contacts below 20 ms. */
static const double STOP_RATE = 50.0, TYRE_RATE = 15.0, CONTACT_RATE = 5.0;
enum { MAX_DEPTH = 2 }; /* depth to which a step is halved at such a change */
enum { MIN_ITERATIONS = 4 }; /* iterations of a half for which the whole was not tried, with a limit of iterations */

/* The larger one by one instruction; a NaN in x is ignored. */
static double larger(double a, double x) { return x > a ? x : a; }

/* Largest one of a contact's forces and of a value. */
static double largest_force_of(const ali3_contact_forces_of *contact, const double *out, double largest) {
  for (int32_t i = contact->n; i-- > 0;) largest = larger(largest, fabs(out[contact->first + i]));
  return largest;
}

/* Largest change of a contact's judged forces between two states; *largest: updated by the forces. */
static double largest_change(const ali3_contact_forces_of *contact, const double *from, const double *to,
                             double *largest) {
  double change = 0.0;
  for (int32_t i = contact->judged + contact->n_judged; i-- > contact->judged;) {
    change = larger(change, fabs(to[i] - from[i]));
    *largest = larger(larger(*largest, fabs(from[i])), fabs(to[i]));
  }
  return change;
}

/* Whether a step that may be halved `depth` times is divided at abrupt changes. */
static bool may_divide(const ali3_instance *in, int32_t depth) {
  return depth > 0 && depth > in->settings.max_halvings - MAX_DEPTH && in->system->nr > 0;
}

bool ali3_allows_division(ali3_instance *in, const ali3_request *request, int32_t iterations) {
  const int64_t remaining = request->iterations_end - in->report.iterations;
  if (in->settings.step_iterations > 0 && remaining < 2 * (int64_t)iterations) {
    in->bound.capped = true;
    return false;
  }
  in->report.divisions++;
  return true;
}

/* Change of a force relative to the largest one above which parts of the present step are halved. */
static double change_limit(const ali3_instance *in, double rate) {
  return fmin(rate * in->inputs.whole_length, ABRUPT * in->settings.part_ratio);
}

/* Whether there is room to divide a step at an abrupt force, which counts as an abrupt step. */
static bool divides_abruptly(ali3_instance *in, const ali3_request *request, int32_t iterations) {
  if (!ali3_allows_division(in, request, iterations)) return false;
  in->report.abrupt_steps++;
  return true;
}

/* Whether a part is made in halves by report.change_rate; counted as an abrupt step, as its halves may have smaller
 * changes. */
static bool divides(ali3_instance *in, const ali3_request *part, int32_t iterations) {
  if (!(may_divide(in, part->depth) && in->report.change_rate * part->h > 1.0)) return false;
  return divides_abruptly(in, part, iterations);
}

bool ali3_divides_ahead(ali3_instance *in, const ali3_request *request) { return divides(in, request, MIN_ITERATIONS); }

/* A change relative to its limit; 0 without a change, as there may be no force. */
static double relative_change(double change, double largest) { return change > 0.0 ? change / largest : 0.0; }

/* Largest change of a judged force from in->now to in->next, over its limit: loads of tyres are relative to the largest
 * load so far, other forces to the largest force. *changed: the change itself. */
static double change_over_limit(const ali3_instance *in, double *changed) {
  const ali3_system *S = in->system;
  enum { STOP, CONTACT, TYRE, KINDS };
  double changes[KINDS] = {0.0}, largest_load = in->report.largest_load, largest_force = in->report.largest_force;
  for (int32_t c = 0; c < S->n_contact; c++) {
    const ali3_contact_forces_of *contact = S->contact + c;
    const int32_t kind = contact->tyre ? TYRE : contact->touches ? CONTACT : STOP;
    double *largest = kind == TYRE ? &largest_load : &largest_force;
    changes[kind] = larger(changes[kind], largest_change(contact, in->now.out, in->next.out, largest));
  }
  *changed = fmax(fmax(changes[TYRE], changes[CONTACT]), changes[STOP]);
  largest_force = fmax(largest_force, largest_load);
  const double load = relative_change(changes[TYRE], change_limit(in, TYRE_RATE) * largest_load),
               force = relative_change(changes[CONTACT], change_limit(in, CONTACT_RATE) * largest_force),
               stop = relative_change(changes[STOP], change_limit(in, STOP_RATE) * largest_force);
  return fmax(fmax(load, force), stop);
}

/* Whether a step that may be halved `depth` times may end early. */
static bool may_end_early(const ali3_instance *in, int32_t depth) {
  return in->settings.step_iterations == 0 && may_divide(in, depth);
}

bool ali3_divides(ali3_instance *in, const ali3_request *request, bool early) {
  double changed;
  if (in->system->nr == 0 || (early && !may_end_early(in, request->depth))) return false;
  const double over = change_over_limit(in, &changed);
  if (early && !(over > 1.0)) return false;
  in->parting.changed = changed;
  in->report.change_rate = over / request->h;
  return divides(in, request, in->report.last_iterations);
}

bool ali3_is_abrupt(const ali3_instance *in, int32_t depth) {
  double changed;
  return may_end_early(in, depth) && change_over_limit(in, &changed) > 1.0;
}

/* Whether a spring is beyond a stop at the start or the end of the step. */
static bool beyond(const ali3_instance *in, const ali3_contact_forces_of *contact) {
  const ali3_system *S = in->system;
  const ali3_element_size *size = S->el_size + contact->element;
  const ali3_element_type *kind = S->el_kind[contact->element];
  return kind->stops(in->parameters.el_parameter + size->real, in->next.out + size->out) ||
         kind->stops(in->parameters.el_parameter + size->real, in->now.out + size->out);
}

/* Largest change of a judged force in the step; without roads only of springs beyond their stops. */
static double step_change(const ali3_instance *in) {
  double change = 0.0, largest = 0.0;
  for (int32_t c = 0; c < in->system->n_contact; c++)
    if (in->system->nr > 0 || beyond(in, in->system->contact + c))
      change = larger(change, largest_change(in->system->contact + c, in->next.out, in->now.out, &largest));
  return change;
}

/* Largest change of a force of a tyre in the step, those along the road among them. */
static double tyre_change(const ali3_instance *in) {
  double change = 0.0;
  for (int32_t c = 0; c < in->system->n_contact; c++) {
    const ali3_contact_forces_of *contact = in->system->contact + c;
    for (int32_t i = contact->first; contact->tyre && i < contact->first + contact->n; i++)
      change = larger(change, fabs(in->now.out[i] - in->next.out[i]));
  }
  return change;
}

void ali3_abrupt_force(ali3_instance *in) {
  ali3_report *r = &in->report;
  for (int32_t c = 0; c < in->system->n_contact; c++) {
    const ali3_contact_forces_of *contact = in->system->contact + c;
    r->largest_force = largest_force_of(contact, in->now.out, r->largest_force);
    if (contact->tyre) /* the load at the start belongs to no step */
      r->largest_load = larger(larger(r->largest_load, in->next.out[contact->judged]), in->now.out[contact->judged]);
  }
  const double change = in->parting.changed < 0.0 ? step_change(in) : in->parting.changed;
  if (larger(change, tyre_change(in)) > ABRUPT * r->largest_force) r->abrupt_steps++;
}

bool ali3_divides_to_resolve(ali3_instance *in, const ali3_request *request, bool at_row) {
  return at_row ? divides_abruptly(in, request, MIN_ITERATIONS) : ali3_allows_division(in, request, MIN_ITERATIONS);
}

double ali3_table_resolved(const ali3_instance *in, int32_t element, double from, double to) {
  const ali3_system *S = in->system;
  const ali3_element_size *at = S->el_size + element;
  return S->el_kind[element]->resolved(in->parameters.el_parameter + at->real, S->el_int + at->integer, from, to,
                                       ABRUPT, in->report.largest_force);
}

double ali3_tables_resolved_step(const ali3_instance *in, double h) {
  const ali3_system *S = in->system;
  if (!S->has_force_tables) return h;
  for (int32_t c = 0; c < S->n_contact; c++) {
    const int32_t e = S->contact[c].element;
    const double *out = in->now.out + S->el_size[e].out;
    if (S->el_kind[e]->resolved != NULL)
      h *= ali3_table_resolved(in, e, out[ALI3_TABLE_LENGTH], out[ALI3_TABLE_LENGTH] + h * out[ALI3_TABLE_RATE]);
  }
  return h;
}
