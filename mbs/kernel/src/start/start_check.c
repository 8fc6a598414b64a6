/* Checks of a start by the elements, rise needed to start, and detection of wheels driven into the road. */
#include <stdio.h>

#include "../elements/road.h"
#include "../elements/tyre_contact.h"
#include "../elements/tyre_fields.h"
#include "../instance.h"
#include "../lookup/lookup.h"
#include "initialise.h"

enum { MAX_RISES = 100 }; /* an element may report its rise in parts */

ali3_element_args ali3_start_arguments(const ali3_instance *in, const ali3_road *roads, const double *q, int32_t e,
                                       double *u) {
  const ali3_system *S = in->system;
  const int32_t first = S->el_sig_ptr[e];
  const ali3_element_args a = {
      .nsig = S->el_sig_ptr[e + 1] - first,
      .nreal = S->el_parameter_ptr[e + 1] - S->el_parameter_ptr[e],
      .nint = S->el_int_ptr[e + 1] - S->el_int_ptr[e],
      .u = u,
      .real = in->parameters.el_parameter + S->el_parameter_ptr[e],
      .integer = S->el_int + S->el_int_ptr[e],
      .roads = roads,
  };
  if (S->n_lookup > 0) {
    ali3_lookup_prepare(in, q);
    ali3_lookup_extend(in, q, q, NULL, true);
    q = in->lookup.extended[0];
  }
  for (int32_t i = 0; i < a.nsig; i++) {
    const int32_t signal = S->el_sig[first + i];
    u[i] = S->sig_const[signal];
    for (int32_t k = S->sig_ptr[signal]; k < S->sig_ptr[signal + 1]; k++) u[i] += S->sig_val[k] * q[S->sig_col[k]];
  }
  return a;
}

/* Verdict of element e on in->now; {0} for elements without a check. */
static ali3_start_verdict verdict(const ali3_instance *in, int32_t e, double raised) {
  double u[ALI3_MAX_SIGNALS] = {0.0};
  if (in->system->el_kind[e]->start == NULL) return (ali3_start_verdict){0};
  const ali3_element_args a = ali3_start_arguments(in, in->roads.used, in->now.q, e, u);
  return in->system->el_kind[e]->start(&a, raised);
}

double ali3_start_excess(const ali3_instance *in, int32_t *element, const char **words) {
  int32_t worst = -1;
  double largest = 0.0, raised = 0.0;
  for (int32_t e = 0; in != NULL && e < in->system->size.ne; e++) {
    const double excess = verdict(in, e, 0.0).excess;
    if (!(excess > largest)) continue;
    largest = excess;
    worst = e;
  }
  for (int32_t e = 0; worst >= 0 && e < in->system->size.ne; e++)
    for (int k = 0; k < MAX_RISES; k++) {
      const double rise = verdict(in, e, raised).rise;
      if (!(rise > 0.0)) break;
      raised += rise;
    }
  if (element != NULL) *element = worst;
  if (words != NULL) *words = worst >= 0 ? in->system->el_kind[worst]->start_words : "";
  return raised;
}

/* radii: depth of a wheel's centre above which it was driven into a face; a rolled-over vehicle presses it some
 * millimetres into the ground */
static const double DEEP = 0.5; /* radii */
static const double NO_FORCE = 1e-6; /* factor on the largest weight on a coordinate */

/* Depth of the tyre of element e at its hub, m: the limit on a road without faces. */
static double hub_depth(const ali3_instance *in, int32_t e) {
  return (1.0 - ALI3_TYRE_HUB) * in->parameters.el_parameter[in->system->el_parameter_ptr[e]];
}

/* The first wheel whose centre is deep in a grid road, with a message; on any road the deepest pressed rim is stored in
 * `report`, if given. */
static ali3_status find_wheel(const ali3_instance *in, ali3_report *report, int32_t *element, char *text, size_t size) {
  if (text != NULL && size > 0) text[0] = 0;
  if (element != NULL) *element = -1;
  for (int32_t e = 0; in != NULL && e < in->system->size.ne; e++) {
    const ali3_system *S = in->system;
    double u[ALI3_MAX_SIGNALS] = {0.0}, spacing[2];
    if (S->el_kind[e]->depth != ali3_tyre_depth) continue;
    const bool grid = ali3_road_spacing(&in->roads.used[S->el_int[S->el_int_ptr[e]]], spacing);
    if (!grid && !(report != NULL && in->now.out[S->el_out_ptr[e] + TYRE_OUT_DEFLECTION] > hub_depth(in, e))) continue;
    const ali3_element_args a = ali3_start_arguments(in, in->roads.used, in->now.q, e, u);
    const ali3_start_verdict v = S->el_kind[e]->start(&a, 0.0);
    const double depth = v.excess, pressed = grid ? v.pressed : depth + a.real[0] - hub_depth(in, e);
    if (report != NULL && pressed > report->rim_pressed) {
      report->rim_pressed = pressed;
      report->rim_time = ali3_time(in);
      report->rim_x = u[0], report->rim_y = u[1];
      report->rim_element = e;
    }
    if (!grid || !(depth > DEEP * a.real[0])) continue;
    if (element != NULL) *element = e;
    if (text != NULL)
      snprintf(
          text, size,
          "at x = %.6g m, y = %.6g m the centre of a wheel of %.3g m radius is %.2g m below the road, whose points "
          "are %.3g by %.3g m apart: it has been driven into a face that is too high",
          u[0], u[1], a.real[0], depth, spacing[0], spacing[1]);
    return ALI3_WHEEL_IN_ROAD;
  }
  return ALI3_OK;
}

ali3_status ali3_wheel_in_road(const ali3_instance *in, int32_t *element, char *text, size_t size) {
  return find_wheel(in, NULL, element, text, size);
}

ali3_status ali3_wheels_watch(ali3_instance *in) { return find_wheel(in, &in->report, NULL, NULL, 0); }

double ali3_no_force(const ali3_instance *in) {
  double largest = 0.0;
  for (int32_t i = 0; in != NULL && i < in->system->size.nq; i++) largest = fmax(largest, fabs(in->mass.gravity[i]));
  return NO_FORCE * largest;
}

ali3_status ali3_rim_text(const ali3_instance *in, int32_t *element, char *text, size_t size) {
  if (in == NULL || text == NULL || size == 0) return ALI3_BAD_ARGUMENT;
  const ali3_report *r = &in->report;
  const int32_t e = (int32_t)r->rim_element;
  const bool pressed = r->rim_pressed > 0.0 && in->system->el_kind[e]->depth == ali3_tyre_depth;
  double spacing[2];
  text[0] = 0;
  if (element != NULL) *element = pressed ? e : -1;
  if (pressed && ali3_road_spacing(&in->roads.used[in->system->el_int[in->system->el_int_ptr[e]]], spacing))
    snprintf(text, size,
             "At %.4g s a wheel at x = %.4g m, y = %.4g m was driven into a face of the road that is too high or too "
             "steep at its speed: the rim is pressed in by %.2g m more than it holds, so loads from there on are those "
             "of a stiff spring. Drive slower there, or take a lower face.",
             r->rim_time, r->rim_x, r->rim_y, r->rim_pressed);
  else if (pressed)
    snprintf(text, size,
             "At %.4g s a wheel at x = %.4g m, y = %.4g m was %.2g m deep in the road: the rim is pressed in by %.2g m "
             "more than it holds, so loads from there on are those of a stiff spring. Let it fall less high, or drive "
             "slower there.",
             r->rim_time, r->rim_x, r->rim_y, r->rim_pressed + hub_depth(in, e), r->rim_pressed);
  return ALI3_OK;
}
