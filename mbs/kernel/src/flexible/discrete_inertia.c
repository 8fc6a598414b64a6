/* Inertia forces of flexible bodies over a step that conserve energy exactly. M is quadratic in q, and with the mean v
 * and half the change w of the velocities v0 and v1
 *   T(q1, v1) - T(q0, v0) = D . ((M1 v1 - M0 v0) / h - g),  g . D = (v0' M1 v1 - v0' M0 v1) / 2,
 * where g, the derivative of v0' M(q) v1 / 2 = T(q, v) - T(q, w) by q at the middle of the step, is exact. */
#include <string.h>

#include "../instance.h"
#include "bodies.h"
#include "body_arrays.h"
#include "discrete_inertia.h"
#include "flexible_body.h"

/* r += weight d T(q, v) / dq at the prepared q, of the part of M that is not constant. With D_il[j] of flexible_body.c
 *   T = .. + r' . a_i' P_i . eta + a_i' . a_l' J_il / 2 + r' . a_l P_l . eta' + a_i' . a_l D_il . eta'. */
static void add_gradient(const ali3_instance *in, const double *v, double weight, double *r) {
  for (int32_t b = 0; b < in->system->n_flexible; b++) {
    const ali3_flexible f = ali3_flexible_of(in, b);
    const int32_t n = f.n;
    const int64_t square = (int64_t)n * n;
    double *restrict rate = in->flexible.work, *restrict force = rate + n, *restrict scaled = force + n;
    double x[12];
    ali3_gather(12, f.frame, v, x);
    ali3_gather(n, f.mode, v, rate);
    memset(force, 0, (size_t)n * sizeof(double));
    for (int l = 0; l < 3; l++) {
      double total[3] = {0.0, 0.0, 0.0};
      const double *al = x + 3 * (l + 1);
      for (int i = 0; i < 4; i++) { /* r_o, then the axes */
        const double *restrict row = i == 0 ? f.P + l * n : f.D + (3 * (i - 1) + l) * n;
        const double *xi = x + 3 * i, along = ali3_product_backward(row, rate, n);
        const double coupling = xi[0] * al[0] + xi[1] * al[1] + xi[2] * al[2];
        for (int k = 0; k < 3; k++) total[k] += xi[k] * along;
        for (int32_t j = 0; j < n; j++) force[j] += coupling * row[j];
      }
      for (int k = 0; k < 3; k++) r[f.frame[3 * (l + 1) + k]] += weight * total[k];
    }
    double axis_products[9]; /* a_i' . a_l */
    for (int i = 0; i < 3; i++)
      for (int l = 0; l < 3; l++) {
        const double *xi = x + 3 * (i + 1), *axis = f.A + 3 * l;
        axis_products[3 * i + l] = xi[0] * axis[0] + xi[1] * axis[1] + xi[2] * axis[2];
      }
    for (int p = 0; p < 3; p++) {
      const int i = (p + 1) % 3, k = (p + 2) % 3;
      const double even = axis_products[3 * i + k] + axis_products[3 * k + i],
                   odd = axis_products[3 * i + k] - axis_products[3 * k + i];
      for (int32_t j = 0; j < n; j++) scaled[j] = axis_products[4 * p] * rate[j];
      ali3_accumulate(n, f.E + p * square, scaled, force);
      for (int32_t j = 0; j < n; j++) scaled[j] = even * rate[j];
      ali3_accumulate(n, f.E + (3 + p) * square, scaled, force);
      for (int32_t j = 0; j < n; j++) scaled[j] = odd * rate[j];
      ali3_accumulate(n, f.H + p * square, scaled, force);
    }
    for (int32_t j = 0; j < n; j++) r[f.mode[j]] += weight * force[j];
  }
}

void ali3_flexible_momentum(const ali3_instance *in, const double *q, const double *v, double *p) {
  memset(p, 0, (size_t)in->system->size.nq * sizeof *p);
  ali3_bodies_prepare(in, q);
  ali3_flexible_mass_times(in, v, p);
}

void ali3_discrete_inertia(const ali3_instance *in, double h, const double *p0, const double *p1, const double *mean,
                           const double *half, double *r) {
  for (int32_t i = 0; i < in->system->size.nq; i++) r[i] += 0.5 * h * (p1[i] - p0[i]);
  add_gradient(in, half, 0.5 * h * h, r);
  add_gradient(in, mean, -0.5 * h * h, r);
}
