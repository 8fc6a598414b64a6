/* Conditions on velocities that no position integrates (rolling, skates): rows A(q) qd = 0 with A_b = row_lin + sum of
 * h q_a. They have no Phi; A takes the place of Phi_q, so projections, accelerations and forces A' lam need no separate
 * code. Where a step solves for positions, the value of such a row is A qd divided by the rate of its rule, whose
 * derivative with respect to the increment is A and a term of the size of the step. */
#include "velocity_rows.h"
#include "../instance.h"
#include "switch_rows.h"

void ali3_velocity_jacobian(const ali3_instance *in, const real *q, real *Phi, real *J) {
  const ali3_system *S = in->system;
  for (int64_t i = 0; i < S->n_velocity_row; i++) {
    Phi[S->velocity_row[i]] = ali3_same(0.0);
    for (int32_t t = S->velocity_ptr[i]; t < S->velocity_ptr[i + 1]; t++)
      J[S->velocity[t].jb] += S->velocity[t].h * q[S->velocity[t].a];
  }
}

void ali3_velocity_gamma(const ali3_instance *in, const real *qd, real *gamma) {
  const ali3_system *S = in->system;
  for (int64_t i = 0; i < S->n_velocity_row; i++) {
    real sum = {0};
    for (int32_t t = S->velocity_ptr[i]; t < S->velocity_ptr[i + 1]; t++)
      sum += S->velocity[t].h * qd[S->velocity[t].a] * qd[S->velocity[t].b];
    gamma[S->velocity_row[i]] = sum;
  }
}

void ali3_velocity_values(const ali3_instance *in, const real *A, const real *v, double rate, real *Phi) {
  const ali3_system *S = in->system;
  for (int64_t i = 0; i < S->n_velocity_row; i++) {
    const int32_t k = S->velocity_row[i];
    real sum = {0};
    for (int32_t j = S->row_ptr[k]; j < S->row_ptr[k + 1]; j++) sum += A[j] * v[S->row_col[j]];
    Phi[k] = sum / rate;
  }
}

void ali3_velocity_middle(const ali3_instance *in, const real *A, const real *D, real *Phi, real *J) {
  const ali3_system *S = in->system;
  ali3_velocity_values(in, A, D, 1.0, Phi);
  for (int64_t i = 0; i < S->n_velocity_row; i++) {
    const int32_t k = S->velocity_row[i];
    for (int32_t j = S->row_ptr[k]; j < S->row_ptr[k + 1]; j++) J[j] = A[j];
    if (ali3_row_is_off(in, k)) continue;
    for (int32_t t = S->velocity_ptr[i]; t < S->velocity_ptr[i + 1]; t++)
      J[S->velocity[t].ja] += 0.5 * S->velocity[t].h * D[S->velocity[t].b];
  }
}

void ali3_velocity_release(const ali3_instance *in, real *J) {
  const ali3_system *S = in->system;
  for (int64_t i = 0; i < S->n_velocity_row; i++) {
    const int32_t k = S->velocity_row[i];
    for (int32_t j = S->row_ptr[k]; j < S->row_ptr[k + 1]; j++) J[j] = ali3_same(0.0);
  }
}
