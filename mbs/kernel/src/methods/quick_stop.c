/* A wheel that drops onto the metal of its rebound stop within a step: by the tangent of the stop its force would have
 * changed by more in the step than any force there is, so that neither its size nor its time can be right. */
#include "quick_stop.h"

#include <math.h>

#include "../elements/element.h"

static const double QUICK = 0.047;  /* sqrt(s); calibrated on random drives of two cars over kerbs and drops */
static const double SAFE = 0.3;     /* of the limit: what a step would do with */
static const double ABRUPT = 0.1;   /* of the largest force: a change in a step */
/* 1/s, times the step that is asked for: of the largest force, a change in a part that halves it, where that is less
 * than ABRUPT. So a run and its refinement divide the same stretches, and the parts shrink with the step: of stops below
 * 2 ms, of contacts below 20 ms. Measured in docs/theory.md. */
static const double STOP_RATE = 50.0, CONTACT_RATE = 5.0;
static const double SPAN = 0.5;     /* s after a hit in which its wheel lands: the largest force there counts too */
enum { DIVISIONS = 2 }; /* how deep a step is halved at such a change */
enum { ENOUGH = 4 };    /* iterations of a half that is made without trying the whole, where they are limited */

/* The change of a force in a step up to which nothing is said. */
static double limit(const ali3_report *r, double h) { return QUICK / sqrt(h) * r->largest_force; }

/* A hit whose span is over, against the largest force in it. */
static void judge(ali3_report *r) {
  const double most = limit(r, r->hit_h);
  if (r->hit_change > fmax(most, r->quick_change)) {
    if (r->quick_change == 0.0) r->quick_time = r->hit_time;
    r->quick_change = r->hit_change;
    r->quick_step = r->hit_h * SAFE * most / r->hit_change;
  }
  r->hit_change = 0.0;
}

int32_t ali3_contact_forces(const ali3_instance *in, int32_t all, double *force) {
  int32_t n = 0;
  for (int32_t c = 0; c < in->system->n_contact; c++) {
    const ali3_contact_forces_of *contact = in->system->contact + c;
    const int32_t first = all != 0 ? contact->first : contact->judged, mine = all != 0 ? contact->n : contact->n_judged;
    for (int32_t i = 0; force != NULL && i < mine; i++) force[n + i] = in->now.out[first + i];
    n += mine;
  }
  return n;
}

/* The larger one, of one instruction; a NaN in x counts as nothing. */
static double more(double most, double x) { return x > most ? x : most; }

/* The largest of a contact's forces and of `most`. */
static double larger(const ali3_contact_forces_of *contact, const double *out, double most) {
  for (int32_t i = contact->n; i-- > 0;) most = more(most, fabs(out[contact->first + i]));
  return most;
}

double ali3_largest_contact_force(const ali3_instance *in) {
  double largest = 0.0;
  for (int32_t c = 0; c < in->system->n_contact; c++) largest = larger(in->system->contact + c, in->now.out, largest);
  return largest;
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

bool ali3_may_divide(const ali3_instance *in, int32_t depth) {
  return depth > 0 && depth > in->settings.max_halvings - DIVISIONS && in->system->nr > 0;
}

bool ali3_leaves_parts(ali3_instance *in, int32_t iterations) {
  const int64_t left = in->iterations_end - in->report.iterations;
  if (in->settings.step_iterations > 0 && left < 2 * (int64_t)iterations) {
    in->capped = true;
    return false;
  }
  in->report.divisions++;
  return true;
}

/* The change from which on parts of the present step are halved. */
static double most_change(const ali3_instance *in, double rate) { return fmin(rate * in->whole_length, ABRUPT); }

/* Whether a part of size h with such a report.change_rate is made in halves. Its parts may change less; who judges
 * abrupt steps afterwards is told of the whole. */
static bool divided(ali3_instance *in, double h, int32_t iterations) {
  if (!(in->may_divide && in->report.change_rate * h > 1.0 && ali3_leaves_parts(in, iterations))) return false;
  in->report.abrupt_steps++;
  return true;
}

bool ali3_divides_ahead(ali3_instance *in, double h) { return divided(in, h, ENOUGH); }

/* A change over the largest one that is not divided; where nothing changes there may be no force. */
static double over(double change, double largest) { return change > 0.0 ? change / largest : 0.0; }

/* A load is measured by the largest load there was, other forces by the largest force. */
bool ali3_divides(ali3_instance *in, double h) {
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
  in->changed = fmax(fmax(most[TYRE], most[CONTACT]), most[STOP]);
  largest_force = fmax(largest_force, largest_load);
  const double load = over(most[TYRE], ABRUPT * largest_load),
               force = over(most[CONTACT], most_change(in, CONTACT_RATE) * largest_force),
               stop = over(most[STOP], most_change(in, STOP_RATE) * largest_force);
  in->report.change_rate = fmax(fmax(load, force), stop) / h;
  return divided(in, h, in->report.last_iterations);
}

/* Forces of a contact after the step, and a hit of its rebound stop. */
static void look_at(ali3_instance *in, double h, const ali3_contact_forces_of *contact) {
  const ali3_system *S = in->system;
  ali3_report *r = &in->report;
  r->largest_force = larger(contact, in->now.out, r->largest_force);
  const int32_t e = contact->element;
  if (S->el_kind[e]->rebound == NULL) return;
  const double *from = in->next.out + S->el_out_ptr[e], *to = in->now.out + S->el_out_ptr[e];
  const ali3_element_size *size = S->el_size + e;
  const double change = S->el_kind[e]->rebound(in->el_real + size->real, size->nreal, from[0], to[0]);
  if (!(change > fmax(limit(r, h), r->hit_change))) return;
  if (r->hit_change == 0.0) {
    r->hit_time = ali3_time(in);
    r->hit_left = SPAN;
  }
  r->hit_change = change;
  r->hit_h = h;
}

/* Largest change of a judged force in the step. */
static double changed(const ali3_instance *in) {
  double most = 0.0, largest = 0.0;
  for (int32_t c = 0; c < in->system->n_contact; c++)
    most = more(most, change_of(in->system->contact + c, in->next.out, in->now.out, &largest));
  return most;
}

/* After a step of size h from in->next to in->now. */
void ali3_quick_stop(ali3_instance *in, double h) {
  ali3_report *r = &in->report;
  for (int32_t c = 0; c < in->system->n_contact; c++) look_at(in, h, in->system->contact + c);
  if ((in->changed < 0.0 ? changed(in) : in->changed) > ABRUPT * r->largest_force) r->abrupt_steps++;
  r->hit_left -= h;
  if (r->hit_change > 0.0 && r->hit_left < 0.5 * h) judge(r);
}
