/* Loops of a tree: rows of its cut joints, and the second transformation, to independent rates. As many rows are chosen
 * as are independent; as many joints depend on the others by them:
 *     J_d x_d + J_i x_i = -b,     x_d = g - G x_i,     R' M R x_i = R' (load - M (g, 0)),     R = (-G, 1). */
#include <math.h>

#include "../algebra/small_vectors.h"
#include "../system.h"
#include "tree.h"

static const double MIN_PIVOT = 1e-7; /* of the largest pivot: a smaller one belongs to a redundant row */
static const double ROUND_OFF = 1e-12; /* of the largest term of the rows: likewise, if all rows are redundant */

/* A cut joint. */
typedef struct {
  int32_t first, second; /* bodies */
  int32_t points, axes; /* numbers of rows: coincident points; axes normal to each other */
  double p[3], n[2][3]; /* point, m, and normals of the first body, earth axes */
  double r[3], z[3]; /* point, m, and axis of the second body, earth axes */
} cut;

/* Cut joint c at the present frames. */
static cut find_cut(const ali3_system *S, const ali3_tree_work *w, int32_t c) {
  const double *place = S->tree_cut_place + 15 * (int64_t)c;
  cut k = {.first = S->tree_cut_body[2 * c],
           .second = S->tree_cut_body[2 * c + 1],
           .points = S->tree_cut_rows[2 * c],
           .axes = S->tree_cut_rows[2 * c + 1]};
  for (int i = 0; i < 3; i++) {
    const double x = w->frame[k.first][i][0], y = w->frame[k.first][i][1], z = w->frame[k.first][i][2];
    const double u = w->frame[k.second][i][0], v = w->frame[k.second][i][1], t = w->frame[k.second][i][2];
    k.p[i] = w->origin[i][k.first] + (x * place[0] + y * place[1] + z * place[2]);
    k.n[0][i] = x * place[3] + y * place[4] + z * place[5];
    k.n[1][i] = x * place[6] + y * place[7] + z * place[8];
    k.r[i] = w->origin[i][k.second] + (u * place[9] + v * place[10] + t * place[11]);
    k.z[i] = u * place[12] + v * place[13] + t * place[14];
  }
  return k;
}

/* Adds the derivatives of the rows from `row` on by the joints on the path of a body: of its point, and of rotation
 * about `arm`. */
static void add_path_derivatives(const ali3_tree *T, ali3_tree_work *w, const cut *k, int32_t body, const double *point,
                                 double sign, const double (*arm)[3], int32_t row) {
  for (int32_t j = body; j > 0; j = T->parent[j]) {
    const double t[3] = {w->turn[0][j], w->turn[1][j], w->turn[2][j]};
    double v[3];
    ali3_cross(t, point, v);
    for (int i = 0; i < 3; i++) w->largest_term = fmax(w->largest_term, fmax(fabs(t[i]), fabs(w->shift[i][j])));
    for (int i = 0; i < k->points; i++) w->row[row + i][j] += sign * (w->shift[i][j] + v[i]);
    for (int i = 0; i < k->axes; i++) w->row[row + k->points + i][j] += sign * ali3_dot(t, arm[i]);
  }
}

void ali3_loops_rows(const ali3_system *S, ali3_tree_work *w, bool gradients) {
  const ali3_tree *T = S->tree;
  int32_t row = 0;
  if (gradients) w->largest_term = 0.0;
  for (int32_t c = 0; c < T->n_cut; c++) {
    const cut k = find_cut(S, w, c);
    for (int i = 0; i < k.points; i++) w->Phi[row + i] = k.p[i] - k.r[i];
    for (int i = 0; i < k.axes; i++) w->Phi[row + k.points + i] = ali3_dot(k.n[i], k.z);
    if (gradients) {
      double arm[2][3];
      for (int i = 0; i < k.axes; i++) ali3_cross(k.n[i], k.z, arm[i]);
      for (int32_t i = row; i < row + k.points + k.axes; i++) {
        ALI3_SHORT
        for (int32_t j = 1; j <= T->n; j++) w->row[i][j] = 0.0;
      }
      add_path_derivatives(T, w, &k, k.first, k.p, 1.0, (const double (*)[3])arm, row);
      add_path_derivatives(T, w, &k, k.second, k.r, -1.0, (const double (*)[3])arm, row);
    }
    row += k.points + k.axes;
  }
}

/* Acceleration of a point of body b without joint accelerations. */
static void find_point_bias(const ali3_tree_work *w, int32_t b, const double r[3], double out[3]) {
  const double o[3] = {w->spin[0][b], w->spin[1][b], w->spin[2][b]};
  const double a[3] = {w->spin_rate[0][b], w->spin_rate[1][b], w->spin_rate[2][b]};
  double v[3], turned[3];
  ali3_cross(o, r, v);
  for (int i = 0; i < 3; i++) v[i] += w->drift[i][b];
  ali3_cross(o, v, turned);
  ali3_cross(a, r, out);
  for (int i = 0; i < 3; i++) out[i] += w->drift_rate[i][b] + turned[i];
}

void ali3_loops_bias(const ali3_system *S, ali3_tree_work *w) {
  int32_t row = 0;
  for (int32_t c = 0; c < S->tree->n_cut; c++) {
    const cut k = find_cut(S, w, c);
    double first[3], second[3], o[2][3], spin_difference[3], spin_rate_difference[3];
    find_point_bias(w, k.first, k.p, first);
    find_point_bias(w, k.second, k.r, second);
    for (int i = 0; i < k.points; i++) w->gamma[row + i] = first[i] - second[i];
    for (int i = 0; i < 3; i++) {
      o[0][i] = w->spin[i][k.first];
      o[1][i] = w->spin[i][k.second];
      spin_difference[i] = o[0][i] - o[1][i];
      spin_rate_difference[i] = w->spin_rate[i][k.first] - w->spin_rate[i][k.second];
    }
    for (int i = 0; i < k.axes; i++) { /* rate of (o1 - o2) . (n x z) */
      double arm[3], nd[3], zd[3], part[3], other[3];
      ali3_cross(k.n[i], k.z, arm);
      ali3_cross(o[0], k.n[i], nd);
      ali3_cross(o[1], k.z, zd);
      ali3_cross(nd, k.z, part);
      ali3_cross(k.n[i], zd, other);
      for (int m = 0; m < 3; m++) part[m] += other[m];
      w->gamma[row + k.points + i] = ali3_dot(spin_rate_difference, arm) + ali3_dot(spin_difference, part);
    }
    row += k.points + k.axes;
  }
}

void ali3_loops_choose(const ali3_tree *T, ali3_tree_work *w) {
  const int32_t m = T->n_row, n = T->n;
  double largest = 0.0;
  for (int32_t i = 0; i < m; i++) {
    w->row_order[i] = i;
    for (int32_t j = 0; j < n; j++) w->upper[i][j] = w->row[i][j + 1];
  }
  for (int32_t j = 0; j < n; j++) w->column_order[j] = j + 1;
  for (w->rank = 0; w->rank < m && w->rank < n; w->rank++) {
    const int32_t k = w->rank;
    int32_t at = k, column = k;
    double best = 0.0;
    for (int32_t i = k; i < m; i++)
      for (int32_t j = k; j < n; j++)
        if (fabs(w->upper[w->row_order[i]][w->column_order[j] - 1]) > best) {
          best = fabs(w->upper[w->row_order[i]][w->column_order[j] - 1]);
          at = i;
          column = j;
        }
    if (k == 0) largest = best;
    if (!(best > fmax(MIN_PIVOT * largest, ROUND_OFF * w->largest_term))) break;
    const int32_t row = w->row_order[at], joint = w->column_order[column];
    w->row_order[at] = w->row_order[k];
    w->row_order[k] = row;
    w->column_order[column] = w->column_order[k];
    w->column_order[k] = joint;
    for (int32_t i = k + 1; i < m; i++) {
      double *other = w->upper[w->row_order[i]];
      const double factor = other[joint - 1] / w->upper[row][joint - 1];
      for (int32_t j = 0; j < n; j++) other[j] -= factor * w->upper[row][j];
    }
  }
}

void ali3_loops_factorise(const ali3_tree *T, ali3_tree_work *w) {
  const int32_t r = w->rank, n = T->n;
  for (int32_t i = 0; i < r; i++) {
    const double *row = w->row[w->row_order[i]];
    ALI3_SHORT
    for (int32_t j = 0; j < n; j++) w->upper[i][j] = row[w->column_order[j]];
  }
  for (int32_t k = 0; k < r; k++) {
    const double inverse = 1.0 / w->upper[k][k];
    for (int32_t i = k + 1; i < r; i++) {
      const double factor = w->upper[i][k] * inverse;
      w->upper[i][k] = factor;
      ALI3_SHORT
      for (int32_t j = k + 1; j < n; j++) w->upper[i][j] -= factor * w->upper[k][j];
    }
    w->upper[k][k] = inverse;
  }
  for (int32_t k = r - 1; k >= 0; k--)
    for (int32_t c = r; c < n; c++) {
      double sum = w->upper[k][c];
      for (int32_t i = k + 1; i < r; i++) sum -= w->upper[k][i] * w->upper[i][c];
      w->upper[k][c] = sum * w->upper[k][k];
    }
}

/* y = J_d^-1 of the chosen rows of b. */
static void solve_dependent(const ali3_tree_work *w, const double *b, double *y) {
  const int32_t r = w->rank;
  for (int32_t i = 0; i < r; i++) {
    y[i] = b[w->row_order[i]];
    for (int32_t k = 0; k < i; k++) y[i] -= w->upper[i][k] * y[k];
  }
  for (int32_t i = r - 1; i >= 0; i--) {
    for (int32_t k = i + 1; k < r; k++) y[i] -= w->upper[i][k] * y[k];
    y[i] *= w->upper[i][i];
  }
}

/* L D L' of w->dense (f x f, lower triangle), inverse pivots on the diagonal. */
static bool factorise_dense(ali3_tree_work *w, int32_t f) {
  bool positive = true;
  for (int32_t k = 0; k < f; k++) {
    positive = positive && w->dense[k][k] > 0.0;
    const double inverse = 1.0 / w->dense[k][k];
    for (int32_t i = k + 1; i < f; i++) {
      const double factor = w->dense[i][k] * inverse;
      for (int32_t j = i; j < f; j++) w->dense[j][i] -= factor * w->dense[j][k];
    }
    for (int32_t i = k + 1; i < f; i++) w->dense[i][k] *= inverse;
    w->dense[k][k] = inverse;
  }
  return positive;
}

/* z becomes the solution with the factorised w->dense. */
static void solve_dense(const ali3_tree_work *w, int32_t f, double *z) {
  for (int32_t i = 0; i < f; i++)
    for (int32_t k = 0; k < i; k++) z[i] -= w->dense[i][k] * z[k];
  for (int32_t i = f - 1; i >= 0; i--) {
    z[i] *= w->dense[i][i];
    for (int32_t k = i + 1; k < f; k++) z[i] -= w->dense[k][i] * z[k];
  }
}

/* w->product = (M R)', w->dense = R' M R factorised. */
static bool reduce_mass(const ali3_tree *T, ali3_tree_work *w) {
  const int32_t r = w->rank, n = T->n, f = n - r;
  for (int32_t j = 1; j <= n; j++)
    for (int32_t i = T->parent[j]; i > 0; i = T->parent[i]) w->mass[i][j] = w->mass[j][i];
  for (int32_t c = 0; c < f; c++) {
    double *product = w->product[c];
    const double *column = w->mass[w->column_order[r + c]];
    for (int32_t j = 1; j <= n; j++) product[j] = column[j];
    for (int32_t d = 0; d < r; d++) {
      const double *row = w->mass[w->column_order[d]], factor = w->upper[d][r + c];
      ALI3_SHORT
      for (int32_t j = 1; j <= n; j++) product[j] -= factor * row[j];
    }
    for (int32_t e = 0; e <= c; e++) {
      double sum = product[w->column_order[r + e]];
      for (int32_t d = 0; d < r; d++) sum -= product[w->column_order[d]] * w->upper[d][r + e];
      w->dense[c][e] = sum;
    }
  }
  return factorise_dense(w, f);
}

bool ali3_loops_solve(const ali3_tree *T, ali3_tree_work *w, double *qdd) {
  const int32_t r = w->rank, n = T->n, f = n - r;
  double g[ALI3_MAX_CUT_ROWS], z[ALI3_LANES];
  const bool positive = reduce_mass(T, w);
  solve_dependent(w, w->gamma, g);
  for (int32_t d = 0; d < r; d++) {
    const double *row = w->mass[w->column_order[d]];
    ALI3_SHORT
    for (int32_t j = 1; j <= n; j++) w->load[j] += g[d] * row[j];
  }
  for (int32_t c = 0; c < f; c++) {
    z[c] = w->load[w->column_order[r + c]];
    for (int32_t d = 0; d < r; d++) z[c] -= w->load[w->column_order[d]] * w->upper[d][r + c];
  }
  solve_dense(w, f, z);
  for (int32_t c = 0; c < f; c++) qdd[w->column_order[r + c] - 1] = z[c];
  for (int32_t d = 0; d < r; d++) {
    double sum = -g[d];
    for (int32_t c = 0; c < f; c++) sum -= w->upper[d][r + c] * z[c];
    qdd[w->column_order[d] - 1] = sum;
  }
  return positive;
}

void ali3_loops_correct(const ali3_tree *T, ali3_tree_work *w, const double *violation, double *x) {
  const int32_t r = w->rank, n = T->n, f = n - r;
  double y[ALI3_MAX_CUT_ROWS], z[ALI3_LANES];
  solve_dependent(w, violation, y);
  for (int32_t c = 0; c < f; c++) {
    z[c] = 0.0;
    for (int32_t d = 0; d < r; d++) z[c] += w->product[c][w->column_order[d]] * y[d];
  }
  solve_dense(w, f, z);
  for (int32_t c = 0; c < f; c++) x[w->column_order[r + c] - 1] += z[c];
  for (int32_t d = 0; d < r; d++) {
    for (int32_t c = 0; c < f; c++) y[d] += w->upper[d][r + c] * z[c];
    x[w->column_order[d] - 1] -= y[d];
  }
}
