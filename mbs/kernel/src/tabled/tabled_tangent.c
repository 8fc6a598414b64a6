/* Tangents of tabled bodies and of elements on them, into fronts. */
#include <string.h>

#include "../algebra/fronts.h"
#include "tabled.h"

enum { FIRST_PARAMETER = 12, BY_A = 1, BY_AA = 3 };

/* Second moments of a body as a 4 x 4 matrix of its vectors. */
static void moments(const double *m, double J[4][4]) {
  const double all[4][4] = {
      {m[0], m[1], m[2], m[3]}, {m[1], m[4], m[9], m[8]}, {m[2], m[9], m[5], m[7]}, {m[3], m[8], m[7], m[6]}};
  memcpy(J, all, sizeof all);
}

/* wM B' M_X B. With X_v = sum_K T_Kv y_K, y = (r, Y): blocks T J T' of r and Y, T J dX/dp with the parameters. */
static void add_mass(const ali3_tabled *c, const ali3_tabled_work *w, double wM, int32_t size, double *block) {
  double J[4][4], T[4][4] = {{1.0}}, G[4][4] = {{0.0}};
  moments(c->mass, J);
  for (int k = 0; k < 3; k++)
    for (int v = 0; v < 4; v++) T[k + 1][v] = w->value[0][3 * v + k];
  for (int K = 0; K < 4; K++)
    for (int v = 0; v < 4; v++)
      for (int u = 0; u < 4; u++) G[K][u] += T[K][v] * J[v][u];
  const int n_par = c->count[1] > 1 ? 2 : 1;
  for (int p = 0; p < n_par; p++) {
    const int32_t at = c->loc[FIRST_PARAMETER + p];
    for (int o = 0; o <= p; o++) {
      double sum = 0.0;
      for (int v = 0; v < 4; v++)
        for (int u = 0; u < 4; u++)
          for (int x = 0; x < 3; x++) sum += J[v][u] * w->by[p][3 * v + x] * w->by[o][3 * u + x];
      ali3_add_lower(block, size, at, c->loc[FIRST_PARAMETER + o], wM * sum);
    }
    for (int K = 0; c->frame[0] >= 0 && K < 4; K++)
      for (int x = 0; x < 3; x++) {
        double sum = 0.0;
        for (int v = 0; v < 4; v++) sum += G[K][v] * w->by[p][3 * v + x];
        ali3_add_lower(block, size, c->loc[3 * K + x], at, wM * sum);
      }
  }
  for (int K = 0; c->frame[0] >= 0 && K < 4; K++)
    for (int L = 0; L <= K; L++) {
      double sum = 0.0;
      for (int v = 0; v < 4; v++) sum += G[K][v] * T[L][v];
      for (int x = 0; x < 3; x++) ali3_add_lower(block, size, c->loc[3 * K + x], c->loc[3 * L + x], wM * sum);
    }
}

/* -wK f d2X/dq2, f the force on X. */
static void add_bend(const ali3_tabled *c, const ali3_tabled_work *w, double wK, int32_t size, double *block) {
  const int n_par = c->count[1] > 1 ? 2 : 1;
  for (int p = 0; p < n_par; p++) {
    const int32_t at = c->loc[FIRST_PARAMETER + p];
    for (int o = 0; o <= p; o++) {
      const double *t = w->value[BY_AA + p + o];
      double sum = 0.0;
      if (c->n != ALI3_TABLED_BODY) sum = w->force[0] * t[0];
      for (int i = 0; c->n == ALI3_TABLED_BODY && i < 12; i++)
        for (int k = 0; k < 3; k++) sum += w->force[i] * w->axes[3 * k + i % 3] * t[3 * (i / 3) + k];
      ali3_add_lower(block, size, at, c->loc[FIRST_PARAMETER + o], -wK * sum);
    }
    if (c->n != ALI3_TABLED_BODY || c->frame[0] < 0) continue;
    for (int k = 0; k < 3; k++)
      for (int x = 0; x < 3; x++) {
        double sum = 0.0;
        for (int v = 0; v < 4; v++) sum += w->force[3 * v + x] * w->value[BY_A + p][3 * v + k];
        ali3_add_lower(block, size, c->loc[3 + 3 * k + x], at, -wK * sum);
      }
  }
}

void ali3_tabled_tangent(const ali3_instance *in, double wM, double wK, double *F) {
  const ali3_system *S = in->system;
  for (int32_t i = 0; i < S->n_tabled; i++) {
    const ali3_tabled *c = S->tabled + i;
    const int32_t size = S->front_ptr[c->front + 1] - S->front_ptr[c->front];
    double *block = F + S->front_off[c->front];
    if (wM != 0.0 && c->n == ALI3_TABLED_BODY && c->mass[0] > 0.0) add_mass(c, in->tabled + i, wM, size, block);
    if (wK != 0.0) add_bend(c, in->tabled + i, wK, size, block);
  }
}

/* Row of B of a signal: its coefficient `value` of dependent d of an item, over the coordinates of the element. */
static void spread(const ali3_tabled *c, const ali3_tabled_work *w, const int32_t *slot, int32_t d, double value,
                   double *row) {
  row[slot[FIRST_PARAMETER]] += value * w->by[0][d];
  if (c->count[1] > 1) row[slot[FIRST_PARAMETER + 1]] += value * w->by[1][d];
  if (c->n != ALI3_TABLED_BODY || c->frame[0] < 0) return;
  const int32_t v = d / 3, x = d % 3;
  if (v == 0) row[slot[x]] += value;
  for (int k = 0; k < 3; k++) row[slot[3 + 3 * k + x]] += value * w->value[0][3 * v + k];
}

/* B' S B of an element with B made of its tables. */
static void element_tangent(ali3_instance *in, int32_t e, const ali3_tabled_element *of, double *F) {
  const ali3_system *S = in->system;
  const int32_t n = S->el_sig_ptr[e + 1] - S->el_sig_ptr[e], m = of->m, front = S->el_front[e];
  const int32_t size = S->front_ptr[front + 1] - S->front_ptr[front];
  const double *tangent = in->S + S->el_S_off[e];
  double *block = F + S->front_off[front];
  double B[ALI3_TABLED_SIGNALS * ALI3_TABLED_MOST], SB[ALI3_TABLED_SIGNALS * ALI3_TABLED_MOST];
  memset(B, 0, (size_t)(n * m) * sizeof *B);
  memset(SB, 0, (size_t)(n * m) * sizeof *SB);
  for (int32_t k = S->el_entry_ptr[e]; k < S->el_entry_ptr[e + 1]; k++) {
    const int32_t d = S->el_entry_dependent[k], local = S->el_entry_local[k];
    double *row = B + S->el_entry_signal[k] * m;
    if (d < 0)
      row[local] += S->el_entry_value[k];
    else
      spread(S->tabled + of->item[local], in->tabled + of->item[local], of->slot[local], d, S->el_entry_value[k], row);
  }
  for (int32_t i = 0; i < n; i++)
    for (int32_t k = 0; k < n; k++) {
      const double s = tangent[i * n + k];
      const double *restrict from = B + k * m;
      double *restrict to = SB + i * m;
      if (s == 0.0) continue;
      for (int32_t j = 0; j < m; j++) to[j] += s * from[j];
    }
  for (int32_t i = 0; i < n; i++) {
    const double *restrict row = SB + i * m;
    for (int32_t j = 0; j < m; j++) {
      const double b = B[i * m + j];
      double *restrict column = block + (int64_t)of->loc[j] * size;
      if (b == 0.0) continue;
      for (int32_t k = j; k < m; k++) column[of->loc[k]] += b * row[k];
    }
  }
}

void ali3_tabled_elements_tangent(ali3_instance *in, double *F) {
  const ali3_system *S = in->system;
  for (int32_t e = 0; e < S->size.ne; e++)
    if (S->el_tabled[e] >= 0 && S->el_front[e] >= 0 && !in->idle[e])
      element_tangent(in, e, S->tabled_element + S->el_tabled[e], F);
}
