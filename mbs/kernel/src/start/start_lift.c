/* A start with a tyre deeper in the road than its radius, its wheel's centre below the surface: no spring of a tyre
 * means that, and it would shoot the scene up. How much higher the scene must begin. */
#include "../elements/element.h"
#include "../elements/element_math.h"
#include "../elements/road.h"
#include "../instance.h"

static const double CLEAR = 1e-6; /* m: a depth that counts as none */
enum { RADIUS = 0, MOST_LIFTS = 100 }; /* the first real of a tyre; walls are climbed a depth at a time */

/* Depth of a tyre when its wheel is raised, m; *climb: the part of it along the road's normal. */
static double depth(const ali3_instance *in, int32_t e, double lift, double *climb) {
  const ali3_system *S = in->system;
  double u[6] = {0.0}, *centre = u, *axis = u + 3, deepest = 0.0;
  for (int i = 0; i < 6; i++) {
    const int32_t signal = S->el_sig[S->el_sig_ptr[e] + i];
    u[i] = S->sig_const[signal];
    for (int32_t k = S->sig_ptr[signal]; k < S->sig_ptr[signal + 1]; k++)
      u[i] += S->sig_val[k] * in->now.q[S->sig_col[k]];
  }
  centre[2] += lift;
  const double length = ali3_norm(axis);
  for (int i = 0; i < 3; i++) axis[i] = length > 1e-6 ? axis[i] / length : (i == 1);
  ali3_contact contact[2];
  const ali3_road *road = &in->road[S->el_int[S->el_int_ptr[e]]];
  const int count = ali3_road_contacts(road, centre, axis, in->el_real[S->el_real_ptr[e] + RADIUS], contact);
  for (int k = 0; k < count; k++)
    if (contact[k].penetration > deepest) {
      deepest = contact[k].penetration;
      *climb = deepest * contact[k].cosine;
    }
  return deepest;
}

double ali3_start_lift(const ali3_instance *in) {
  if (in == NULL) return 0.0;
  const ali3_system *S = in->system;
  double lift = 0.0, climb = 0.0;
  bool below = false;
  for (int32_t e = 0; e < S->size.ne; e++)
    if (S->el_type[e] == ALI3_TYRE && depth(in, e, 0.0, &climb) > in->el_real[S->el_real_ptr[e] + RADIUS]) below = true;
  if (!below) return 0.0;
  for (int32_t e = 0; e < S->size.ne; e++)
    for (int k = 0; S->el_type[e] == ALI3_TYRE && k < MOST_LIFTS && depth(in, e, lift, &climb) > CLEAR; k++)
      lift += climb;
  return lift;
}
