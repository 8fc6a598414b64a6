/* Elements of the lanes without a vector law, evaluated one instance after the other, as in a single run. */
#include "../elements/element.h"
#include "../elements/forces.h"
#include "../methods/abrupt_force.h"
#include "group.h"

/* Arguments of the elements of lane l in the present step. */
static ali3_force_call step_call(const ali3_lane_group *g, int32_t l) {
  const ali3_instance *in = g->lane[l];
  const ali3_vectors *to = &in->next;
  const ali3_force_call call = {.y_old = in->now.y,
                                .h = g->h,
                                .reach = g->reach[l],
                                .wC = g->rule.wC,
                                .wK = g->rule.c,
                                .y_new = to->y,
                                .out = to->out,
                                .potential = to->potential};
  return call;
}

/* Signals and rates of element e in lane l. */
static void gather_signals(const ali3_lane_group *g, int32_t e, int32_t l, double *u, double *ud) {
  const ali3_system *S = g->system;
  for (int32_t i = S->el_sig_ptr[e]; i < S->el_sig_ptr[e + 1]; i++) {
    *u++ = g->element.u[S->el_sig[i] * g->width + l];
    *ud++ = g->element.ud[S->el_sig[i] * g->width + l];
  }
}

/* Evaluates f, idle and, if required, the tangent of element e in lane l. */
static void evaluate_lane(ali3_lane_group *g, const ali3_force_call *call, int32_t e, int32_t l, real *forces,
                          bool tangent) {
  const ali3_system *S = g->system;
  const int32_t width = g->width, n = S->el_sig_ptr[e + 1] - S->el_sig_ptr[e];
  double u[ALI3_MAX_SIGNALS], ud[ALI3_MAX_SIGNALS], f[ALI3_MAX_SIGNALS], T[ALI3_MAX_SIGNALS * ALI3_MAX_SIGNALS];
  const bool with_tangent = tangent && S->el_front[e] >= 0;
  gather_signals(g, e, l, u, ud);
  const bool idle = ali3_element_forces(g->lane[l], call, e, u, ud, f, with_tangent ? T : NULL);
  g->element.idle[e * width + l] = idle ? -1 : 0;
  real *to = g->element.S + (int64_t)S->el_S_off[e] * width + l;
  for (int32_t i = 0; i < n; i++) forces[i * width + l] = f[i];
  if (with_tangent && !(idle && S->n_flexible == 0)) /* the tangent of an idle element is not read */
    for (int32_t i = 0; i < n * n; i++) to[i * width] = T[i];
}

void ali3_lane_element(ali3_lane_group *g, int32_t e, real *f, bool tangent) {
  for (int32_t l = 0; l < g->width; l++) {
    if (!g->evaluated[l]) continue;
    const ali3_force_call call = step_call(g, l);
    evaluate_lane(g, &call, e, l, f, tangent);
  }
}

bool ali3_lane_is_abrupt(const ali3_lane_group *g, int32_t lane) {
  const ali3_instance *in = g->lane[lane];
  for (int32_t c = 0; c < g->system->n_contact; c++) {
    const ali3_contact_forces_of *contact = g->system->contact + c;
    if (!g->by_law[contact->element]) continue; /* others have written their outputs to the instance */
    for (int32_t i = contact->judged; i < contact->judged + contact->n_judged; i++)
      in->next.out[i] = g->out[i * g->width + lane];
  }
  return ali3_is_abrupt(in, in->settings.max_halvings);
}

void ali3_lane_elements_accept(ali3_lane_group *g, int32_t lane) {
  ali3_instance *in = g->lane[lane];
  const ali3_system *S = g->system;
  const ali3_force_call call = step_call(g, lane);
  double u[ALI3_MAX_SIGNALS], ud[ALI3_MAX_SIGNALS];
  for (int32_t e = 0; e < S->size.ne; e++) {
    if (S->el_kind[e]->accept == NULL) continue;
    gather_signals(g, e, lane, u, ud);
    ali3_element_accept(in, &call, e, u, ud);
  }
}
