/* A wheel that drops onto the metal of its rebound stop within a step: by the tangent of the stop its force would have
 * changed by more in the step than any force there is, so that neither its size nor its time can be right. */
#include "quick_stop.h"

#include <math.h>

#include "../elements/element.h"
#include "../elements/tyre_contact.h"

static const double QUICK = 0.047;  /* sqrt(s); calibrated on random drives of two cars over kerbs and drops */
static const double SAFE = 0.3;     /* of the limit: what a step would do with */
static const double ABRUPT = 0.1;   /* of the largest force: a change in a step */
static const double SPAN = 0.5;     /* s after a hit in which its wheel lands: the largest force there counts too */
enum { DIVISIONS = 2 }; /* how deep a step is halved at such a change */
enum { ENOUGH = 4 };    /* iterations of a half that is made without trying the whole, where they are limited */
enum { LOAD = 2, OF_A_TYRE = 3 };   /* output of a tyre; first outputs of what touches a road that are forces */

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

/* Outputs of an element that are forces of a contact or a stop: how many, and the first. Of a tyre its load, or all: the
 * others follow pedals that jump. */
static int32_t forces_of(const ali3_system *S, int32_t e, bool all, int32_t *first) {
  const ali3_element_type *kind = S->el_kind[e];
  const int32_t n_out = S->el_out_ptr[e + 1] - S->el_out_ptr[e];
  const bool tyre = kind->depth == ali3_tyre_depth && !all;
  *first = S->el_out_ptr[e] + (tyre ? LOAD : kind->rebound != NULL ? 1 : 0);
  return tyre || kind->rebound != NULL ? 1 : kind->depth == NULL ? 0 : n_out < OF_A_TYRE ? n_out : OF_A_TYRE;
}

int32_t ali3_contact_forces(const ali3_instance *in, int32_t all, double *force) {
  int32_t n = 0;
  for (int32_t c = 0; c < in->system->n_contact; c++) {
    int32_t first;
    const int32_t mine = forces_of(in->system, in->system->contact_element[c], all != 0, &first);
    for (int32_t i = 0; force != NULL && i < mine; i++) force[n + i] = in->now.out[first + i];
    n += mine;
  }
  return n;
}

double ali3_largest_contact_force(const ali3_instance *in) {
  double largest = 0.0;
  for (int32_t c = 0; c < in->system->n_contact; c++) {
    int32_t first;
    for (int32_t i = forces_of(in->system, in->system->contact_element[c], true, &first); i-- > 0;)
      largest = fmax(largest, fabs(in->now.out[first + i]));
  }
  return largest;
}

/* Largest change of such a force of element e in a step between two of its ends; *largest: of these forces. */
static double change_of(const ali3_system *S, int32_t e, const double *from, const double *to, double *largest) {
  int32_t first;
  double most = 0.0;
  for (int32_t i = forces_of(S, e, false, &first); i-- > 0;) {
    most = fmax(most, fabs(to[first + i] - from[first + i]));
    *largest = fmax(*largest, fmax(fabs(from[first + i]), fabs(to[first + i])));
  }
  return most;
}

bool ali3_may_divide(const ali3_instance *in, int32_t depth) {
  return depth > 0 && depth > in->settings.max_halvings - DIVISIONS && in->system->nr > 0;
}

/* Whether a part in which a force changes abruptly is made in halves: where a limit of the step's iterations leaves so
 * many for each. Else the limit ends the step, as one whose iterations it stops. The parts may change less; who judges
 * abrupt steps afterwards is told of the whole. */
static bool divided(ali3_instance *in, bool abrupt, int32_t iterations) {
  if (!(in->may_divide && abrupt)) return false;
  const int64_t left = in->iterations_end - in->report.iterations;
  if (in->settings.step_iterations > 0 && left < 2 * (int64_t)iterations) {
    in->capped = true;
    return false;
  }
  in->report.divisions++;
  in->report.abrupt_steps++;
  return true;
}

bool ali3_divides_ahead(ali3_instance *in, double h) {
  return divided(in, in->report.change_rate * h > ABRUPT, ENOUGH);
}

/* A load is measured by the largest load there was, other forces by the largest force. */
bool ali3_divides(ali3_instance *in, double h) {
  const ali3_system *S = in->system;
  if (S->nr == 0) return false;
  double load = 0.0, force = 0.0, largest_load = in->report.largest_load, largest_force = in->report.largest_force;
  for (int32_t c = 0; c < S->n_contact; c++) {
    const int32_t e = S->contact_element[c];
    const bool tyre = S->el_kind[e]->depth == ali3_tyre_depth;
    double *most = tyre ? &load : &force, *largest = tyre ? &largest_load : &largest_force;
    *most = fmax(*most, change_of(S, e, in->now.out, in->next.out, largest));
  }
  largest_force = fmax(largest_force, largest_load);
  const double change = fmax(load > 0.0 ? load / largest_load : 0.0, force > 0.0 ? force / largest_force : 0.0);
  in->report.change_rate = change / h;
  return divided(in, change > ABRUPT, in->report.last_iterations);
}

/* Largest change of such a force of element e in the step. */
static double look_at(ali3_instance *in, double h, int32_t e) {
  const ali3_system *S = in->system;
  ali3_report *r = &in->report;
  const ali3_element_type *kind = S->el_kind[e];
  const double *from = in->next.out + S->el_out_ptr[e], *to = in->now.out + S->el_out_ptr[e];
  int32_t first;
  double largest = 0.0;
  const double most = change_of(S, e, in->next.out, in->now.out, &largest);
  for (int32_t i = forces_of(S, e, true, &first); i-- > 0;)
    r->largest_force = fmax(r->largest_force, fabs(in->now.out[first + i]));
  if (kind->rebound == NULL) return most;
  const int32_t nreal = S->el_real_ptr[e + 1] - S->el_real_ptr[e];
  const double change = kind->rebound(in->el_real + S->el_real_ptr[e], nreal, from[0], to[0]);
  if (!(change > fmax(limit(r, h), r->hit_change))) return most;
  if (r->hit_change == 0.0) {
    r->hit_time = ali3_time(in);
    r->hit_left = SPAN;
  }
  r->hit_change = change;
  r->hit_h = h;
  return most;
}

/* After a step of size h from in->next to in->now. */
void ali3_quick_stop(ali3_instance *in, double h) {
  ali3_report *r = &in->report;
  double most = 0.0;
  for (int32_t c = 0; c < in->system->n_contact; c++) most = fmax(most, look_at(in, h, in->system->contact_element[c]));
  if (most > ABRUPT * r->largest_force) r->abrupt_steps++;
  r->hit_left -= h;
  if (r->hit_change > 0.0 && r->hit_left < 0.5 * h) judge(r);
}
