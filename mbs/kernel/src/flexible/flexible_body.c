/* Flexible bodies: M = B' M_FEM B (13), Q_v = -B' M_FEM Bd qd (14), gravity, elastic and damping forces, from shape
 * integrals. The mass matrix of the System holds what of M is constant; here is what the amplitudes eta and the axes
 * change. With D_ik[j] = sum m (x + phi eta)_i phi_kj and A = [a b c]:
 *   (r, a_i) P_i . eta, (a_i, a_l) J_il - J0_il, (r, eta_j) A P_j, (a_i, eta_j) A D_i[j].
 * Sums over modes run along columns, so that their order does not depend on the width of vectors. */
#include <string.h>

#include "../algebra/fronts.h"
#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../instance.h"
#include "body_arrays.h"
#include "flexible_body.h"

/* Axes A, P eta, D and J - J0 of one body, see body_arrays.h. */
ALI3_INLINED void prepare_body(const ali3_instance *in, const ali3_flexible *f, const real *q) {
  const int32_t n = f->n;
  const int64_t square = (int64_t)n * n;
  real *restrict eta = in->flexible.work, *restrict even = eta + n, *restrict odd = even + n;
  ali3_gather(9, f->frame + 3, q, f->A);
  ali3_gather(n, f->mode, q, eta);
  for (int i = 0; i < 3; i++) ali3_add_product(n, f->E + i * square, eta, f->c + 4 * i * n, f->D + 4 * i * n);
  for (int p = 0; p < 3; p++) { /* the pairs yz, zx, xy: sum m phi_i phi_k' = E - H, its transpose E + H */
    const int i = (p + 1) % 3, k = (p + 2) % 3;
    real *restrict ik = f->D + (3 * i + k) * n, *restrict ki = f->D + (3 * k + i) * n;
    const real *c_ik = f->c + (3 * i + k) * n, *c_ki = f->c + (3 * k + i) * n;
    memset(even, 0, 2 * (size_t)n * sizeof *even);
    ali3_accumulate(n, f->E + (3 + p) * square, eta, even);
    ali3_accumulate(n, f->H + p * square, eta, odd);
    for (int32_t j = 0; j < n; j++) {
      ik[j] = c_ik[j] + (even[j] - odd[j]);
      ki[j] = c_ki[j] + (even[j] + odd[j]);
    }
  }
  ali3_three_products(n, f->P, eta, f->S);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k <= i; k++)
      f->J[3 * i + k] = f->J[3 * k + i] =
          ali3_product_backward(f->c + (3 * k + i) * n, eta, n) + ali3_product_backward(f->D + (3 * i + k) * n, eta, n);
}

ALI3_INLINED void flexible_prepare(const ali3_instance *in, const real *q) {
  for (int32_t b = 0; b < in->system->n_flexible; b++) {
    const ali3_flexible f = ali3_flexible_of(in, b);
    prepare_body(in, &f, q);
  }
}

ALI3_INLINED void flexible_mass_times(const ali3_instance *in, const real *x, real *out) {
  for (int32_t b = 0; b < in->system->n_flexible; b++) {
    const ali3_flexible f = ali3_flexible_of(in, b);
    const int32_t n = f.n;
    real *restrict rate = in->flexible.work, *restrict force = rate + n;
    real v[12], local[3], back[3], local_r[3] = {0};
    ali3_gather(12, f.frame, x, v);
    ali3_gather(n, f.mode, x, rate);
    memset(force, 0, (size_t)n * sizeof *force);
    for (int i = 0; i < 4; i++) { /* r_o, then the axes */
      const real *a = v + 3 * i, *rows = i == 0 ? f.P : f.D + 3 * (i - 1) * n;
      real total[3] = {0};
      ali3_three_products(n, rows, rate, local);
      for (int l = 0; l < 3; l++) {
        const real *axis = f.A + 3 * l;
        back[l] = axis[0] * a[0] + axis[1] * a[1] + axis[2] * a[2];
        for (int k = 0; k < 3; k++) total[k] += axis[k] * local[l];
      }
      ali3_add_three_rows(n, rows, back, force);
      if (i > 0) {
        for (int k = 0; k < 3; k++) {
          total[k] += f.S[i - 1] * v[k];
          local_r[k] += f.S[i - 1] * a[k];
          for (int l = 0; l < 3; l++) total[k] += f.J[3 * (i - 1) + l] * v[3 * (l + 1) + k];
        }
      }
      for (int k = 0; k < 3; k++) out[f.frame[3 * i + k]] += total[k];
    }
    for (int k = 0; k < 3; k++) out[f.frame[k]] += local_r[k];
    ali3_add_to_modes(&f, force, 1.0, out);
  }
}

/* Q += Q_v, gravity except its constant part, elastic and damping forces at the prepared q. With discrete gradients
 * without Q_v: their inertia forces are in discrete_inertia.c. */
ALI3_INLINED void flexible_forces(const ali3_instance *in, const real *q, const real *qd, bool discrete, real *Q) {
  for (int32_t b = 0; b < in->system->n_flexible; b++) {
    const ali3_flexible f = ali3_flexible_of(in, b);
    const int32_t n = f.n;
    real *restrict x = in->flexible.work, *restrict sum = x + n, *restrict rate = sum + n;
    const double *g = f.gravity, inertia_factor = discrete ? 0.0 : 1.0;
    real Ad[9];
    ali3_gather(9, f.frame + 3, qd, Ad);
    for (int i = 0; i < 9; i++) Ad[i] *= inertia_factor;
    ali3_gather(n, f.mode, qd, rate);
    ali3_gather(n, f.mode, q, x);
    memset(sum, 0, (size_t)n * sizeof *sum);
    ali3_accumulate(n, f.K, x, sum);
    ali3_accumulate(n, f.C, rate, sum);
    for (int p = 0; p < 3; p++) { /* A'Ad is skew: of sum m phi_j' A'Ad phi_l only H = (sum m phi_i phi_k' - ...)/2 */
      const real *ai = f.A + 3 * ((p + 1) % 3), *ak = f.A + 3 * ((p + 2) % 3);
      const real *di = Ad + 3 * ((p + 1) % 3), *dk = Ad + 3 * ((p + 2) % 3);
      const real spin =
          0.5 * ((ai[0] * dk[0] + ai[1] * dk[1] + ai[2] * dk[2]) - (ak[0] * di[0] + ak[1] * di[1] + ak[2] * di[2]));
      for (int32_t j = 0; j < n; j++) x[j] = 4.0 * spin * rate[j];
      ali3_accumulate(n, f.H + p * (int64_t)n * n, x, sum);
    }
    for (int i = 0; i < 4; i++) {
      real total[3] = {0}, local[3];
      ali3_three_products(n, i == 0 ? f.P : f.D + 3 * (i - 1) * n, rate, local);
      for (int l = 0; l < 3; l++)
        for (int k = 0; k < 3; k++) total[k] -= 2.0 * Ad[3 * l + k] * local[l];
      for (int k = 0; k < 3; k++) Q[f.frame[3 * i + k]] += total[k] + (i > 0 ? f.S[i - 1] * g[k] : ali3_same(0.0));
    }
    real weight[3];
    for (int l = 0; l < 3; l++) weight[l] = -(f.A[3 * l] * g[0] + f.A[3 * l + 1] * g[1] + f.A[3 * l + 2] * g[2]);
    ali3_add_three_rows(n, f.P, weight, sum);
    ali3_add_to_modes(&f, sum, -1.0, Q);
  }
}

/* Lower triangle of wC C + wK K into the body's front. */
ALI3_INLINED void add_moduli(const ali3_flexible *f, int32_t size, double wC, double wK, real *block) {
  const int32_t n = f->n, *mode = f->loc + 12;
  const bool contiguous = ali3_consecutive(mode, n);
  for (int32_t j = 0; j < n; j++) {
    const double *restrict C = f->C + (int64_t)j * n, *restrict K = f->K + (int64_t)j * n;
    real *restrict column = block + (int64_t)mode[j] * size;
    if (contiguous)
      for (int32_t i = j; i < n; i++) column[mode[0] + i] += wC * C[i] + wK * K[i];
    else
      for (int32_t i = j; i < n; i++) column[mode[i]] += wC * C[i] + wK * K[i];
  }
}

/* Adds the rows of the modes in the columns of the frame. Usually the frame precedes the modes, which are contiguous;
 * not if the body's front has many other coordinates. */
ALI3_INLINED void add_coupling(const ali3_flexible *f, int32_t size, double wM, double wK, real *block) {
  const int32_t n = f->n, *mode = f->loc + 12;
  bool contiguous = ali3_consecutive(mode, n);
  for (int i = 0; i < 12; i++) contiguous = contiguous && f->loc[i] < mode[0];
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 3; k++) {
      const real *restrict X = i == 0 ? f->P : f->D + 3 * (i - 1) * n, *restrict Y = X + n, *restrict Z = Y + n;
      const real *restrict gravity_row = i == 0 ? f->P : f->P + (i - 1) * n;
      const real ax = wM * f->A[k], ay = wM * f->A[3 + k], az = wM * f->A[6 + k];
      const double g = i == 0 ? 0.0 : wK * f->gravity[k];
      const int32_t at = f->loc[3 * i + k];
      real *restrict column = block + (int64_t)at * size + mode[0];
      if (contiguous) {
        ALI3_BY_FOURS
        for (int32_t j = 0; j < n; j++) column[j] += (ax * X[j] + ay * Y[j]) + (az * Z[j] - g * gravity_row[j]);
        continue;
      }
      for (int32_t j = 0; j < n; j++)
        ali3_add_lower(block, size, at, mode[j], (ax * X[j] + ay * Y[j]) + (az * Z[j] - g * gravity_row[j]));
    }
}

ALI3_INLINED void flexible_tangent(const ali3_instance *in, double wM, double wC, double wK, real *F) {
  const ali3_system *s = in->system;
  for (int32_t b = 0; b < s->n_flexible; b++) {
    const ali3_flexible f = ali3_flexible_of(in, b);
    const int32_t front = s->flex_front[b], size = s->front_ptr[front + 1] - s->front_ptr[front];
    real *block = F + s->front_off[front];
    for (int i = 0; i < 3; i++)
      for (int k = 0; k < 3; k++) {
        const int32_t axis = f.loc[3 + 3 * i + k];
        ali3_add_lower(block, size, axis, f.loc[k], wM * f.S[i]);
        for (int l = 0; l <= i; l++) ali3_add_lower(block, size, axis, f.loc[3 + 3 * l + k], wM * f.J[3 * i + l]);
      }
    add_coupling(&f, size, wM, wK, block);
    if (wC != 0.0 || wK != 0.0) add_moduli(&f, size, wC, wK, block);
  }
}

ALI3_BY_PROCESSOR(in->system, void, flexible_prepare, (const ali3_instance *in, const real *q), (in, q))

ALI3_BY_PROCESSOR(in->system, void, flexible_mass_times, (const ali3_instance *in, const real *x, real *out),
                  (in, x, out))

ALI3_BY_PROCESSOR(in->system, void, flexible_forces,
                  (const ali3_instance *in, const real *q, const real *qd, bool discrete, real *Q),
                  (in, q, qd, discrete, Q))

ALI3_BY_PROCESSOR(in->system, void, flexible_tangent,
                  (const ali3_instance *in, double wM, double wC, double wK, real *F), (in, wM, wC, wK, F))

#ifndef ALI3_WIDTH /* scalar only */
/* K eta of the amplitudes eta in x; eta stays in in->flexible.work. */
ALI3_INLINED const double *elastic_force(const ali3_instance *in, const ali3_flexible *f, const double *x) {
  double *eta = in->flexible.work, *force = eta + f->n;
  ali3_gather(f->n, f->mode, x, eta);
  memset(force, 0, (size_t)f->n * sizeof(double));
  ali3_accumulate(f->n, f->K, eta, force);
  return force;
}

ALI3_INLINED void flexible_energy(const ali3_instance *in, const double *q, double *gravity, double *elastic) {
  for (int32_t b = 0; b < in->system->n_flexible; b++) {
    const ali3_flexible f = ali3_flexible_of(in, b);
    const double *force = elastic_force(in, &f, q);
    *elastic += 0.5 * ali3_product_backward(force, in->flexible.work, f.n);
    for (int i = 0; i < 3; i++)
      for (int k = 0; k < 3; k++) *gravity -= f.gravity[k] * f.A[3 * i + k] * f.S[i];
  }
}

ALI3_BY_PROCESSOR(in->system, void, flexible_energy,
                  (const ali3_instance *in, const double *q, double *gravity, double *elastic),
                  (in, q, gravity, elastic))

void ali3_flexible_stiffen(const ali3_instance *in, double weight, double *F) {
  const ali3_system *s = in->system;
  for (int32_t b = 0; b < s->n_flexible; b++) {
    const ali3_flexible f = ali3_flexible_of(in, b);
    const int32_t front = s->flex_front[b], size = s->front_ptr[front + 1] - s->front_ptr[front];
    add_moduli(&f, size, 0.0, weight, F + s->front_off[front]);
  }
}

void ali3_flexible_elastic(const ali3_instance *in, double weight, const double *x, double *out) {
  for (int32_t b = 0; b < in->system->n_flexible; b++) {
    const ali3_flexible f = ali3_flexible_of(in, b);
    const double *force = elastic_force(in, &f, x);
    ali3_add_to_modes(&f, force, weight, out);
  }
}
#endif
