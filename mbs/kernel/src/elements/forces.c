/* Evaluation of elements: signals, forces, and tangents in coordinates. */
#include <string.h>

#include "../algebra/processor.h"
#include "../flexible/flexible_body.h"
#include "../instance.h"
#include "../lookup/lookup.h"
#include "defect.h"
#include "element.h"
#include "element_batches.h"
#include "forces.h"
#include "signals.h"

/* Arguments that are the same for all elements. */
static ali3_element_args common_arguments(const ali3_instance *in, const ali3_force_call *call) {
  return (ali3_element_args){.h = call->h,
                             .reach = call->reach,
                             .wC = call->wC,
                             .wK = call->wK,
                             .input = in->inputs.forces,
                             .roads = in->roads.used};
}

/* Arguments of element e at its signals u and their rates ud; f and S belong to the caller. */
static void element_arguments(const ali3_instance *in, const ali3_force_call *call, int32_t e, const double *u,
                              const double *ud, double *f, double *tangent, ali3_element_args *a) {
  const ali3_system *S = in->system;
  const ali3_element_size *size = S->el_size + e;
  a->nsig = size->nsig;
  a->nreal = size->nreal;
  a->nint = size->nint;
  a->nstate = size->nstate;
  a->nout = size->nout;
  a->u = u;
  a->ud = ud;
  a->y_old = call->y_old + size->state;
  a->y_new = call->y_new + size->state;
  a->real = in->parameters.el_parameter + size->real;
  a->integer = S->el_int + size->integer;
  a->f = f;
  a->S = tangent;
  a->out = call->out + size->out;
  a->potential = 0.0;
  a->idle = 0;
  a->piece = 0;
}

/* The signals of element e and their rates. */
static void gather_signals(const ali3_instance *in, int32_t e, double *u, double *ud) {
  const ali3_system *S = in->system;
  for (int32_t i = S->el_sig_ptr[e]; i < S->el_sig_ptr[e + 1]; i++) {
    *u++ = in->element.u[S->el_sig[i]];
    *ud++ = in->element.ud[S->el_sig[i]];
  }
}

/* Evaluates element e at its own signals; f and tangent (NULL: none) are overwritten. Returns whether both are zero. */
ALI3_INLINED bool evaluate(ali3_instance *in, const ali3_force_call *call, int32_t e, const double *u, const double *ud,
                           double *f, double *tangent, ali3_element_args *a) {
  const ali3_element_type *type = in->system->el_kind[e];
  element_arguments(in, call, e, u, ud, f, tangent, a);
  memset(f, 0, (size_t)a->nsig * sizeof(double));
  if (tangent != NULL) memset(tangent, 0, (size_t)(a->nsig * a->nsig) * sizeof(double));
  (call->discrete && type->discrete != NULL ? type->discrete : type->evaluate)(a);
  call->potential[e] = a->potential;
  return a->idle != 0;
}

bool ali3_element_forces(ali3_instance *in, const ali3_force_call *call, int32_t e, const double *u, const double *ud,
                         double *f, double *tangent) {
  ali3_element_args a = common_arguments(in, call);
  return evaluate(in, call, e, u, ud, f, tangent, &a);
}

/* Stores power and forces of the elements with work sensors. */
static void store_work_forces(ali3_instance *in) {
  const ali3_system *S = in->system;
  double *restrict force = in->watch.now + S->n_work;
  for (int32_t k = 0; k < S->n_work; k++) {
    const int32_t e = S->work_element[k];
    double power = 0.0;
    for (int32_t i = S->el_sig_ptr[e]; i < S->el_sig_ptr[e + 1]; i++) {
      const double f = *force++ = in->element.force[i];
      power += f * in->element.ud[S->el_sig[i]];
    }
    in->watch.now[k] = power;
  }
}

/* Evaluates the signals that elements use, dependents included. */
static void evaluate_signals(ali3_instance *in, const double *q, const double *qd) {
  if (in->system->n_lookup > 0) {
    ali3_lookup_prepare(in, q);
    ali3_lookup_extend(in, q, qd, NULL, false);
    q = in->lookup.extended[0], qd = in->lookup.extended[1];
  }
  if (in->system->n_active > 0) ali3_active_signals(in, q, qd);
}

void ali3_elements_forces(ali3_instance *in, const ali3_force_call *call) {
  const ali3_system *S = in->system;
  double u[ALI3_MAX_SIGNALS], ud[ALI3_MAX_SIGNALS]; /* of an element whose signals are not contiguous */
  ali3_element_args a = common_arguments(in, call);
  if (!call->discrete && S->n_batches > 0) ali3_batches_forces(in, call); /* only on processors with AVX2 */
  const int32_t n = call->discrete ? S->size.ne : S->n_alone;
  for (int32_t k = 0; k < n; k++) {
    const int32_t e = call->discrete ? k : S->alone[k];
    double *tangent = call->tangent && S->el_front[e] >= 0 ? in->element.S + S->el_S_off[e] : NULL;
    double *f = in->element.force + S->el_sig_ptr[e];
    const int32_t contiguous = S->el_beside[e];
    if (contiguous < 0) gather_signals(in, e, u, ud);
    in->element.idle[e] = evaluate(in, call, e, contiguous < 0 ? u : in->element.u + contiguous,
                                   contiguous < 0 ? ud : in->element.ud + contiguous, f, tangent, &a);
  }
}

void ali3_forces(ali3_instance *in, const ali3_force_call *call) {
  const ali3_system *S = in->system;
  double *Q = S->n_lookup > 0 ? in->lookup.force : call->Q; /* followed by those on dependents */
  evaluate_signals(in, call->q, call->qd);
  memcpy(Q, in->mass.gravity, (size_t)S->size.nq * sizeof(double));
  if (S->n_flexible > 0) {
    ali3_flexible_prepare(in, call->q);
    ali3_flexible_forces(in, call->q, call->qd, call->discrete, call->Q);
    in->element.wC = call->wC;
    in->element.wK = call->wK;
  }
  if (S->n_lookup > 0) {
    memset(Q + S->size.nq, 0, (size_t)S->n_dependent * sizeof(double));
    in->element.wC = call->wC;
    in->element.wK = call->wK;
  }
  if (S->size.ne > 0) {
    ali3_elements_forces(in, call);
    ali3_add_forces(in, in->element.force, Q);
  }
  if (S->n_lookup > 0) ali3_lookup_forces(in, call->qd, call->Q);
  if (!call->iterate) store_work_forces(in);
}

void ali3_forces_tangent(ali3_instance *in, double *F) {
  if (in->system->n_flexible > 0) ali3_flexible_tangent(in, 1.0, in->element.wC, in->element.wK, F);
  if (in->system->size.ne > 0) ali3_elements_tangent(in, F);
  if (in->system->n_lookup > 0) {
    ali3_lookup_tangent(in, 1.0, in->element.wK, F);
    ali3_lookup_elements_tangent(in, F);
  }
}

void ali3_law_pieces(ali3_instance *in, uint32_t *piece) {
  if (in == NULL || piece == NULL) return;
  double u[ALI3_MAX_SIGNALS], ud[ALI3_MAX_SIGNALS], f[ALI3_MAX_SIGNALS];
  const ali3_force_call call = {.q = in->now.q,
                                .qd = in->now.qd,
                                .y_old = in->now.y,
                                .y_new = in->element.y,
                                .out = in->element.out,
                                .potential = in->element.potential};
  evaluate_signals(in, call.q, call.qd);
  for (int32_t e = 0; e < in->system->size.ne; e++) {
    ali3_element_args a = common_arguments(in, &call);
    gather_signals(in, e, u, ud);
    element_arguments(in, &call, e, u, ud, f, NULL, &a);
    memset(f, 0, sizeof f);
    in->system->el_kind[e]->evaluate(&a);
    piece[e] = a.piece;
  }
}

void ali3_elements_defect(ali3_instance *in, double h, bool lanes, const double *q, const double *qd, double *r) {
  const ali3_system *S = in->system;
  double u[ALI3_MAX_SIGNALS], ud[ALI3_MAX_SIGNALS], f[ALI3_MAX_SIGNALS];
  const ali3_force_call call = {.q = q,
                                .qd = qd,
                                .y_old = in->now.y,
                                .h = h,
                                .wC = in->rule.wC,
                                .wK = in->rule.c,
                                .y_new = in->element.y,
                                .out = in->element.out,
                                .potential = in->element.potential};
  (void)lanes;
  memset(r, 0, (size_t)S->size.nq * sizeof *r);
  ali3_active_signals(in, q, qd);
  for (int32_t e = 0; e < S->size.ne; e++) {
    if (S->el_front[e] < 0) continue;
    gather_signals(in, e, u, ud);
    ali3_element_forces(in, &call, e, u, ud, f, NULL);
    ali3_add_defect(in, e, ud, f, r);
  }
}

void ali3_element_accept(ali3_instance *in, const ali3_force_call *call, int32_t e, const double *u, const double *ud) {
  double f[ALI3_MAX_SIGNALS] = {0.0};
  ali3_element_args a = common_arguments(in, call);
  element_arguments(in, call, e, u, ud, f, NULL, &a);
  in->system->el_kind[e]->accept(&a);
}

void ali3_forces_accept(ali3_instance *in, const ali3_force_call *call) {
  double u[ALI3_MAX_SIGNALS], ud[ALI3_MAX_SIGNALS];
  for (int32_t e = 0; e < in->system->size.ne; e++) {
    if (in->system->el_kind[e]->accept == NULL) continue;
    gather_signals(in, e, u, ud);
    ali3_element_accept(in, call, e, u, ud);
  }
}
