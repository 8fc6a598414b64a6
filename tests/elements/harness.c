/* Calls one element or one road directly, with flat arguments: tests need neither a System nor the rest of the
 * kernel. */
#include <string.h>

#include "elements/element.h"
#include "elements/road.h"

#if defined(_WIN32)
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

EXPORT int32_t harness_has_discrete(int32_t type) { return ali3_element_type_get(type)->discrete != NULL; }

/* sizes: nsig, nreal, nint, nstate, nout */
EXPORT int32_t harness_sizes_match(int32_t type, const int32_t sizes[5], const int32_t *integer) {
  return ali3_element_fits(ali3_element_type_get(type), sizes[0], sizes[1], integer, sizes[2], sizes[3], sizes[4]);
}

EXPORT const char *harness_check(int32_t type, const int32_t sizes[5], const double *real, const int32_t *integer,
                                 int32_t n_inputs, int32_t n_roads) {
  const ali3_element_type *t = ali3_element_type_get(type);
  if (!ali3_element_fits(t, sizes[0], sizes[1], integer, sizes[2], sizes[3], sizes[4])) return "sizes do not fit";
  return ali3_element_check(t, sizes[0], real, sizes[1], integer, sizes[2], n_inputs, n_roads);
}

EXPORT int32_t harness_conservative(int32_t type, const double *real, int32_t nreal, const int32_t *integer) {
  const ali3_element_type *t = ali3_element_type_get(type);
  return t->conservative && !(t->lossy && t->lossy(real, nreal, integer));
}

/* out: excess and rise; 0: the element has no verdict on starts */
EXPORT int32_t harness_start(int32_t type, const int32_t sizes[5], const double *u, double raised, const double *real,
                             const int32_t *integer, int32_t road_type, int32_t road_nreal,
                             const double *road_parameter, double out[2]) {
  const ali3_element_type *t = ali3_element_type_get(type);
  const ali3_road road = {road_type, road_nreal, road_parameter, NULL, NULL};
  const ali3_element_args a = {
      .nsig = sizes[0], .nreal = sizes[1], .nint = sizes[2], .u = u, .real = real, .integer = integer, .roads = &road};
  if (!t->start) return 0;
  const ali3_start_verdict verdict = t->start(&a, raised);
  out[0] = verdict.excess;
  out[1] = verdict.rise;
  return t->start_words != NULL;
}

EXPORT double harness_evaluate(int32_t type, int32_t accepted, int32_t discrete, const int32_t sizes[5],
                               const double *u, const double *ud, const double *y_old, double *y_new, double h,
                               double wC, double wK, double reach, const double *real, const int32_t *integer,
                               const double *input, int32_t road_type, int32_t road_nreal, const double *road_parameter,
                               double *f, double *S, double *out) {
  const ali3_element_type *t = ali3_element_type_get(type);
  const ali3_road road = {road_type, road_nreal, road_parameter, NULL, NULL};
  ali3_element_args a = {sizes[0], sizes[1], sizes[2], sizes[3], sizes[4], u, ud, y_old, y_new, h, reach, wC,
                         wK,       real,     integer,  input,    &road,    f, S,  out,   0.0,   0, 0};
  memset(f, 0, (size_t)sizes[0] * sizeof *f);
  if (S) memset(S, 0, (size_t)(sizes[0] * sizes[0]) * sizeof *S);
  (discrete ? t->discrete : t->evaluate)(&a);
  if (accepted && t->accept) t->accept(&a);
  return a.potential;
}

EXPORT const char *harness_road_check(int32_t type, const double *real, int32_t nreal) {
  return ali3_road_check(type, real, nreal);
}

/* out: per contact penetration, point, normal, down, cosine, friction (12 numbers) */
EXPORT int32_t harness_contacts(int32_t type, int32_t nreal, const double *real, const double *centre,
                                const double *axis, double radius, double out[24]) {
  const ali3_road road = {type, nreal, real, NULL, NULL};
  ali3_contact contact[2];
  const int32_t count = ali3_road_contacts(&road, centre, axis, radius, contact);
  for (int32_t i = 0; i < count; i++) {
    double *o = out + 12 * i;
    o[0] = contact[i].penetration;
    memcpy(o + 1, contact[i].point, sizeof contact[i].point);
    memcpy(o + 4, contact[i].normal, sizeof contact[i].normal);
    memcpy(o + 7, contact[i].down, sizeof contact[i].down);
    o[10] = contact[i].cosine;
    o[11] = contact[i].friction;
  }
  return count;
}
