/* Signals to elements, element forces and tangents back to coordinates. */
#include <string.h>

#include "../flexible/flexible_body.h"
#include "../instance.h"
#include "element.h"
#include "forces.h"

static void active_signals(ali3_instance *in, const double *q, const double *qd) {
  const ali3_system *S = in->system;
  for (int32_t a = 0; a < S->n_active; a++) {
    const int32_t i = S->active_signal[a];
    double u = S->sig_const[i], ud = 0.0;
    for (int32_t k = S->sig_ptr[i]; k < S->sig_ptr[i + 1]; k++) {
      const double v = S->sig_val[k];
      u += v * q[S->sig_col[k]];
      ud += v * qd[S->sig_col[k]];
    }
    in->u[i] = u;
    in->ud[i] = ud;
  }
}

/* Local signals and the arguments of element e; f and the local copies live with the caller. */
static void prepare(ali3_instance *in, const ali3_force_call *call, int32_t e, double *u, double *ud, double *f,
                    ali3_element_args *a) {
  const ali3_system *S = in->system;
  const int32_t first = S->el_sig_ptr[e], n = S->el_sig_ptr[e + 1] - first;
  for (int32_t i = 0; i < n; i++) {
    u[i] = in->u[S->el_sig[first + i]];
    ud[i] = in->ud[S->el_sig[first + i]];
    f[i] = 0.0;
  }
  a->nsig = n;
  a->nreal = S->el_real_ptr[e + 1] - S->el_real_ptr[e];
  a->nint = S->el_int_ptr[e + 1] - S->el_int_ptr[e];
  a->nstate = S->el_state_ptr[e + 1] - S->el_state_ptr[e];
  a->nout = S->el_out_ptr[e + 1] - S->el_out_ptr[e];
  a->u = u;
  a->ud = ud;
  a->y_old = call->y_old + S->el_state_ptr[e];
  a->y_new = call->y_new + S->el_state_ptr[e];
  a->h = call->h;
  a->wC = call->wC;
  a->wK = call->wK;
  a->real = in->el_real + S->el_real_ptr[e];
  a->integer = S->el_int + S->el_int_ptr[e];
  a->input = in->force_input;
  a->roads = in->road;
  a->f = f;
  a->S = NULL;
  a->out = call->out + S->el_out_ptr[e];
  a->potential = 0.0;
  a->idle = 0;
}

/* Power and forces of element e on its n signals, where a sensor asks for its work. */
static void record(ali3_instance *in, int32_t e, const double *f, const double *ud, int32_t n) {
  const ali3_system *S = in->system;
  const int32_t k = S->work_of[e];
  if (k < 0) return;
  double *force = in->watched + S->n_work + S->work_ptr[k], power = 0.0;
  for (int32_t i = 0; i < n; i++) {
    force[i] = f[i];
    power += f[i] * ud[i];
  }
  in->watched[k] = power;
}

void ali3_forces(ali3_instance *in, const ali3_force_call *call) {
  const ali3_system *S = in->system;
  double u[ALI3_MAX_SIGNALS], ud[ALI3_MAX_SIGNALS], f[ALI3_MAX_SIGNALS];
  active_signals(in, call->q, call->qd);
  memcpy(call->Q, in->gravity_force, (size_t)S->size.nq * sizeof(double));
  if (S->n_flexible > 0) {
    ali3_flexible_prepare(in, call->q);
    ali3_flexible_forces(in, call->q, call->qd, call->Q);
    in->wC = call->wC;
    in->wK = call->wK;
  }
  for (int32_t e = 0; e < S->size.ne; e++) {
    ali3_element_args a;
    prepare(in, call, e, u, ud, f, &a);
    if (call->tangent && S->el_front[e] >= 0) {
      a.S = in->S + S->el_S_off[e];
      memset(a.S, 0, (size_t)(a.nsig * a.nsig) * sizeof(double));
    }
    const ali3_element_type *type = S->el_kind[e];
    (in->discrete && type->discrete != NULL ? type->discrete : type->evaluate)(&a);
    call->potential[e] = a.potential;
    in->idle[e] = (unsigned char)a.idle;
    if (S->n_work > 0) record(in, e, f, ud, a.nsig);
    if (a.idle) continue;
    for (int32_t i = 0; i < a.nsig; i++) {
      const int32_t signal = S->el_sig[S->el_sig_ptr[e] + i];
      for (int32_t k = S->sig_ptr[signal]; k < S->sig_ptr[signal + 1]; k++)
        call->Q[S->sig_col[k]] += S->sig_val[k] * f[i];
    }
  }
}

/* Adds B' S B of every element to its front, B = d(signals)/d(coordinates), S from the last ali3_forces with a
 * tangent. */
void ali3_elements_tangent(ali3_instance *in, double *F) {
  const ali3_system *S = in->system;
  double *restrict SB = in->SB; /* a row per signal, a column per coordinate of the element */
  for (int32_t e = 0; e < S->size.ne; e++) {
    const int32_t front = S->el_front[e];
    if (front < 0 || in->idle[e]) continue;
    const int32_t n = S->el_sig_ptr[e + 1] - S->el_sig_ptr[e];
    const int32_t m = S->el_coordinate_ptr[e + 1] - S->el_coordinate_ptr[e];
    const int32_t *loc = S->el_coordinate_loc + S->el_coordinate_ptr[e];
    const int32_t size = S->front_ptr[front + 1] - S->front_ptr[front];
    double *block = F + S->front_off[front];
    memset(SB, 0, (size_t)(n * m) * sizeof(double));
    for (int32_t k = S->el_entry_ptr[e]; k < S->el_entry_ptr[e + 1]; k++) {
      const double *row = in->S + S->el_S_off[e] + S->el_entry_signal[k] * n, value = S->el_entry_value[k];
      for (int32_t i = 0; i < n; i++) SB[i * m + S->el_entry_local[k]] += row[i] * value;
    }
    for (int32_t k = S->el_entry_ptr[e]; k < S->el_entry_ptr[e + 1]; k++) {
      const double *row = SB + S->el_entry_signal[k] * m, value = S->el_entry_value[k];
      const int32_t j = S->el_entry_local[k];
      double *restrict column = block + (int64_t)loc[j] * size;
      if (loc[m - 1] - loc[0] == m - 1) {
        for (int32_t i = j; i < m; i++) column[loc[0] + i] += value * row[i];
      } else {
        for (int32_t i = j; i < m; i++) column[loc[i]] += value * row[i];
      }
    }
  }
}

/* The same with the flexible bodies, their changing mass too. */
void ali3_forces_tangent(ali3_instance *in, double *F) {
  if (in->system->n_flexible > 0) ali3_flexible_tangent(in, 1.0, in->wC, in->wK, F);
  ali3_elements_tangent(in, F);
}

void ali3_forces_accept(ali3_instance *in, const ali3_force_call *call) {
  const ali3_system *S = in->system;
  double u[ALI3_MAX_SIGNALS], ud[ALI3_MAX_SIGNALS], f[ALI3_MAX_SIGNALS];
  for (int32_t e = 0; e < S->size.ne; e++) {
    if (S->el_kind[e]->accept == NULL) continue;
    ali3_element_args a;
    prepare(in, call, e, u, ud, f, &a);
    S->el_kind[e]->accept(&a);
  }
}
