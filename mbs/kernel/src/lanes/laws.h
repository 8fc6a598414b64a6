/* The laws of elements, compiled for lanes as kernels.h compiles the step: a law sees all lanes of an element at once.
 * Lanes that have ended see what they saw last and get the same again. */
#ifndef ALI3_LAWS_H
#define ALI3_LAWS_H
#ifdef ALI3_LANED /* by kernels.h */

static inline real ALI3_LANED(tanh)(real x) {
  for (int l = 0; l < ALI3_WIDTH; l++) x[l] = ali3_tanh(x[l]);
  return x;
}

#define ali3_road ali3_lane_road
#define ali3_tanh ALI3_LANED(tanh)
#define ali3_atan2 ALI3_LANED(atan2)
#define ali3_road_contacts ALI3_LANED(road_contacts)
#define ali3_contacts_by_numbers ALI3_LANED(contacts_by_numbers)
#define ali3_half_space ALI3_LANED(half_space)
#define ali3_tmeasy_at ALI3_LANED(tmeasy_at)
#define ali3_tmeasy_pair_at ALI3_LANED(tmeasy_pair_at)
#define ali3_tmeasy_secant ALI3_LANED(tmeasy_secant)
#define ali3_tmeasy_trail ALI3_LANED(tmeasy_trail)
#define ali3_tyre_axis ALI3_LANED(tyre_axis)
#define ali3_tyre_radial ALI3_LANED(tyre_radial)
#define ali3_tyre_axes ALI3_LANED(tyre_axes)
#define ali3_tyre_moving ALI3_LANED(tyre_moving)
#define ali3_tyre_velocities ALI3_LANED(tyre_velocities)
#define ali3_tyre_outputs ALI3_LANED(tyre_outputs)
#define ali3_tyre_semidefinite ALI3_LANED(tyre_semidefinite)
#define ali3_end_stops_at ALI3_LANED(end_stops_at)
#define ali3_contact_force ALI3_LANED(contact_force)
#define ali3_contact_loss ALI3_LANED(contact_loss)

#include "../algebra/inverse_tangent.c"
#include "../elements/contact_law.c"
#include "../elements/end_stops.c"
#include "../elements/half_space.c"
#include "../elements/plane_and_kerb.c"
#include "../elements/tmeasy.c"
#include "../elements/tyre_contact.c"

#define evaluate spring_damper_law
#include "../elements/spring_damper.c"
#undef evaluate
#define evaluate gyroscopic_spin_law
#include "../elements/gyroscopic_spin.c"
#undef evaluate
#define evaluate drag_law
#include "../elements/drag.c"
#undef evaluate
#define evaluate tyre_law
#include "../elements/tyre.c"
#undef evaluate
#define evaluate brake_law
#include "../elements/brake.c"
#undef evaluate
#define evaluate spin_angle_law
#include "../elements/spin_angle.c"
#undef evaluate

int ali3_road_contacts(const ali3_road *road, const real centre[3], const real axis[3], real radius,
                       ali3_contact out[2]) {
  if (road->type == ALI3_ROAD_PLANE || road->type == ALI3_ROAD_KERB)
    return ali3_contacts_by_numbers(road->type, road->numbers, *road->friction_factor, centre, axis, radius, out);
  ali3_lane_contacts(road, centre, axis, &radius, (real *)out);
  return 2;
}

static ali3_element_function *law_of(const ali3_element_type *type) {
#define ALI3_LAW(name)                                                                                                 \
  if (type == &ali3_##name) return name##_law;
  ALI3_LAWS(ALI3_LAW)
#undef ALI3_LAW
  return NULL;
}

/* Element e of all lanes: f, y, out, potential, idle and, where it is wanted, the tangent. */
static void ali3_lane_law(ali3_lane_group *g, int32_t e, bool tangent) {
  const ali3_system *S = g->system;
  const int32_t *signal = S->el_sig + S->el_sig_ptr[e], n = S->el_sig_ptr[e + 1] - S->el_sig_ptr[e];
  real u[ALI3_MAX_SIGNALS], ud[ALI3_MAX_SIGNALS];
  for (int32_t i = 0; i < n; i++) u[i] = g->u[signal[i]], ud[i] = g->ud[signal[i]];
  ali3_element_args a = {.nsig = n,
                         .nreal = S->el_real_ptr[e + 1] - S->el_real_ptr[e],
                         .nint = S->el_int_ptr[e + 1] - S->el_int_ptr[e],
                         .nstate = S->el_state_ptr[e + 1] - S->el_state_ptr[e],
                         .nout = S->el_out_ptr[e + 1] - S->el_out_ptr[e],
                         .u = u,
                         .ud = ud,
                         .y_old = g->now.y + S->el_state_ptr[e],
                         .y_new = g->next.y + S->el_state_ptr[e],
                         .h = g->h,
                         .wC = g->rule.wC,
                         .wK = g->rule.c,
                         .real = g->el_real + S->el_real_ptr[e],
                         .integer = S->el_int + S->el_int_ptr[e],
                         .input = g->input,
                         .roads = g->road,
                         .f = g->f + S->el_sig_ptr[e],
                         .S = tangent && S->el_front[e] >= 0 ? g->S + S->el_S_off[e] : NULL,
                         .out = g->out + S->el_out_ptr[e]};
  memset(a.f, 0, (size_t)n * sizeof *a.f);
  if (a.S != NULL) memset(a.S, 0, (size_t)(n * n) * sizeof *a.S);
  law_of(S->el_kind[e])(&a);
  g->potential[e] = a.potential;
  g->idle[e] = (truth){0} - a.idle;
}

#undef ali3_road
#endif
#endif
