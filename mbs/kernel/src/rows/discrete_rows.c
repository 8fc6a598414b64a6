/* Discrete derivative A of the rows over a step: A (q1 - q0) = Phi(q1, s) - Phi(q0, s) at mean driving function
 * factors, exactly. For quadratic rows it is the mean of Phi_q at both ends; driven and angle rows are products of
 * three factors, for which the mean of the derivatives differs from the derivative of the means by products of two
 * increments. */
#include <string.h>

#include "../algebra/elementary.h"
#include "../algebra/number_pairs.h"
#include "../instance.h"
#include "discrete_rows.h"
#include "switch_rows.h"

/* Corrects A for terms with driving functions that change from s0 to s1. */
static void correct_guided(const ali3_instance *in, const double *D, const double *s0, const double *s1) {
  const ali3_system *S = in->system;
  for (int64_t t = 0; t < S->n_gterm_row; t++) {
    const ali3_driving_term *g = &S->gterm[t];
    if (ali3_row_is_off(in, g->row)) continue;
    const double a = s0[g->driving], b = s1[g->driving];
    const double quarter = 0.25 * g->term.h * (g->power == 1 ? b - a : (b - a) * (b + a));
    if (g->term.a >= 0 && g->term.b >= 0) {
      in->discrete.A[g->term.ja] -= quarter * D[g->term.b];
      in->discrete.A[g->term.jb] -= quarter * D[g->term.a];
    }
  }
}

/* ali3_cos(theta) S - ali3_sin(theta) C: with mean cosine, sine, S, C and the exact difference quotients of cosine and
 * sine. */
static void correct_angle(const ali3_instance *in, const double *D, const double *q1, int64_t i) {
  const ali3_system *S = in->system;
  const int32_t theta = S->angle_theta_col[i];
  const double half = 0.5 * D[theta], middle = q1[theta] - half, sm = ali3_sin(middle), cm = ali3_cos(middle);
  const double quotient = half * half < 1e-8 ? 1.0 - half * half / 6.0 : ali3_sin(half) / half,
               excess = ali3_cos(half) - quotient;
  const double change_c = -2.0 * sm * ali3_sin(half), change_s = 2.0 * cm * ali3_sin(half);
  double sum_s = 0.0, sum_c = 0.0, difference_s = 0.0, difference_c = 0.0; /* of S and C at both ends */
  for (int32_t t = S->angle_ptr[i]; t < S->angle_ptr[i + 1]; t++) {
    const ali3_angle_term *x = &S->angle[t];
    const double a1 = x->a < 0 ? 1.0 : q1[x->a], b1 = x->b < 0 ? 1.0 : q1[x->b];
    const double da = x->a < 0 ? 0.0 : D[x->a], db = x->b < 0 ? 0.0 : D[x->b];
    const double quarter = 0.25 * (change_c * x->hs - change_s * x->hc);
    const double product = a1 * b1 + (a1 - da) * (b1 - db), change = a1 * db + da * b1 - da * db;
    sum_s += x->hs * product;
    sum_c += x->hc * product;
    difference_s += x->hs * change;
    difference_c += x->hc * change;
    if (x->a >= 0) in->discrete.A[x->ja] -= quarter * db;
    if (x->b >= 0) in->discrete.A[x->jb] -= quarter * da;
  }
  in->discrete.A[S->angle_theta_j[i]] +=
      0.25 * (change_s * difference_s + change_c * difference_c) + 0.5 * excess * (sm * sum_s + cm * sum_c);
}

/* in->discrete.A from in->discrete.J0 and in->tangent.J, Phi_q at the start and at the end q1 of the step. */
void ali3_discrete_rows(ali3_instance *in, const double *D, const double *q1, const ali3_vectors *from,
                        const ali3_vectors *to) {
  const ali3_system *S = in->system;
  const double *at_start = in->discrete.J0, *at_end = in->tangent.J;
  double *A = in->discrete.A;
  ALI3_EACH(0, S->size.nnz_rows, ALI3_AT(A) = 0.5 * (ALI3_AT(at_start) + ALI3_AT(at_end)))
  correct_guided(in, D, from->s, to->s);
  for (int64_t i = 0; i < S->n_angle_row; i++) correct_angle(in, D, q1, i);
}
