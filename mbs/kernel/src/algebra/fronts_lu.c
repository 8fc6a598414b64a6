/* Multifrontal L U of a matrix with a symmetric pattern but not quite symmetric values: the fronts of the tangent, full
 * blocks instead of lower triangles, no pivoting. A factorised front has L below the diagonal (its unit diagonal is not
 * stored) and U above, with the inverse of its diagonal. A coordinate may stand for several unknowns (`width`), which
 * are consecutive in vectors and fronts. */
#include "../instance.h"
#include "front_block.h"
#include "fronts.h"
#include "processor.h"

/* Eliminates panels of pivots: columns of the panel among themselves, then all of the panel from each later column. */
static ali3_status eliminate(ali3_instance *in, double *block, int32_t first, int32_t n_pivot, int32_t n,
                             int32_t width) {
  for (int32_t start = 0; start < n_pivot; start += PANEL) {
    const int32_t end = start + PANEL < n_pivot ? start + PANEL : n_pivot;
    for (int32_t p = start; p < end; p++) {
      double *restrict column = block + (int64_t)p * n;
      for (int32_t k = start; k < p; k++) {
        const double *restrict pivot_column = block + (int64_t)k * n, factor = column[k];
        ALI3_EACH(k + 1, n, ALI3_AT(column) -= factor * ALI3_AT(pivot_column))
      }
      const ali3_status status = ali3_check_pivot(in, first + p / width, column[p]);
      if (status != ALI3_OK) return status;
      const double inverse = 1.0 / column[p];
      column[p] = inverse;
      ALI3_EACH(p + 1, n, ALI3_AT(column) *= inverse)
    }
    for (int32_t j = end; j < n; j++) {
      double *restrict column = block + (int64_t)j * n;
      if (end - start == PANEL) {
        const double *restrict a = block + (int64_t)start * n, *restrict b = a + n, *restrict c = b + n,
                               *restrict d = c + n;
        const double u0 = column[start], u1 = column[start + 1] - a[start + 1] * u0,
                     u2 = column[start + 2] - (a[start + 2] * u0 + b[start + 2] * u1),
                     u3 = column[start + 3] - (a[start + 3] * u0 + b[start + 3] * u1 + c[start + 3] * u2);
        column[start + 1] = u1;
        column[start + 2] = u2;
        column[start + 3] = u3;
        ALI3_EACH(end, n, ALI3_AT(column) -= (u0 * ALI3_AT(a) + u1 * ALI3_AT(b)) + (u2 * ALI3_AT(c) + u3 * ALI3_AT(d)))
      } else {
        for (int32_t p = start; p < end; p++) {
          const double *restrict pivot_column = block + (int64_t)p * n, factor = column[p];
          ALI3_EACH(p + 1, n, ALI3_AT(column) -= factor * ALI3_AT(pivot_column))
        }
      }
    }
  }
  return ALI3_OK;
}

void ali3_mirror(const ali3_instance *in, double *F) {
  const ali3_system *S = in->system;
  for (int32_t f = 0; f < S->size.nf; f++) {
    const int32_t n = S->front_ptr[f + 1] - S->front_ptr[f];
    double *block = F + S->front_off[f];
    for (int32_t j = 0; j < n; j++) ALI3_SHORT
    for (int32_t i = j + 1; i < n; i++) block[(int64_t)i * n + j] = block[(int64_t)j * n + i];
  }
}

/* Factorises F, in which the offset of a front is width^2 times that in the tangent. */
ALI3_INLINED ali3_status factorise(ali3_instance *in, int32_t width, double *F) {
  const ali3_system *S = in->system;
  const int64_t square = (int64_t)width * width;
  in->report.factorizations++;
  in->report.negative_pivots = 0;
  for (int32_t f = 0; f < S->size.nf; f++) {
    const int32_t first = S->front_col[f], n_pivot_coordinates = S->front_col[f + 1] - first,
                  coordinates = S->front_ptr[f + 1] - S->front_ptr[f], n_pivot = width * n_pivot_coordinates,
                  n = width * coordinates;
    const int32_t *map = S->front_map + S->front_ptr[f], parent = S->front_parent[f];
    double *block = F + square * S->front_off[f];
    const ali3_status status = eliminate(in, block, first, n_pivot, n, width);
    if (status != ALI3_OK) return status;
    if (parent < 0) continue;
    const int32_t parent_n = width * (S->front_ptr[parent + 1] - S->front_ptr[parent]);
    for (int32_t j = n_pivot; j < n; j++) {
      const double *column = block + (int64_t)j * n;
      double *target = F + square * S->front_off[parent] + (int64_t)(width * map[j / width] + j % width) * parent_n;
      for (int32_t i = n_pivot_coordinates; i < coordinates; i++)
        for (int32_t s = 0; s < width; s++) target[width * map[i] + s] += column[width * i + s];
    }
  }
  return ALI3_OK;
}

/* The case of one unknown is compiled separately, as its loops would cost small fronts five percent. */
ali3_status ali3_factorise_lu(ali3_instance *in, int32_t width, double *F) {
  return width == 1 ? factorise(in, 1, F) : factorise(in, ALI3_RADAU, F);
}

/* Back substitution for the pivots of x, whose other entries are the solution; by two columns of U at a time. */
static void backward(const double *block, double *restrict x, int32_t n_pivot, int32_t n) {
  int32_t j = n - 1;
  for (; j > n_pivot; j -= 2) {
    const double *restrict b = block + (int64_t)j * n, *restrict a = b - n;
    const double first = x[j - 1], second = x[j];
    ALI3_EACH(0, n_pivot, ALI3_AT(x) -= ALI3_AT(a) * first + ALI3_AT(b) * second)
  }
  if (j == n_pivot) {
    const double *restrict a = block + (int64_t)j * n, first = x[j];
    ALI3_EACH(0, n_pivot, ALI3_AT(x) -= ALI3_AT(a) * first)
  }
  for (int32_t p = n_pivot - 1; p >= 0; p--) {
    const double *restrict column = block + (int64_t)p * n, factor = x[p] * column[p];
    x[p] = factor;
    ALI3_EACH(0, p, ALI3_AT(x) -= factor * ALI3_AT(column))
  }
}

/* Solves in place: b becomes the solution. */
ALI3_INLINED void solve(ali3_instance *in, int32_t width, const double *F, double *b) {
  const ali3_system *S = in->system;
  const int64_t square = (int64_t)width * width;
  in->report.solves++;
  for (int32_t f = 0; f < S->size.nf; f++) {
    double *x = ali3_front_unknowns(in, f, width, b);
    ali3_front_forward(F + square * S->front_off[f], x, width * (S->front_col[f + 1] - S->front_col[f]),
                       width * (S->front_ptr[f + 1] - S->front_ptr[f]));
    ali3_front_put_back(in, f, width, x, true, b);
  }
  for (int32_t f = S->size.nf - 1; f >= 0; f--) {
    double *x = ali3_front_unknowns(in, f, width, b);
    backward(F + square * S->front_off[f], x, width * (S->front_col[f + 1] - S->front_col[f]),
             width * (S->front_ptr[f + 1] - S->front_ptr[f]));
    ali3_front_put_back(in, f, width, x, false, b);
  }
}

void ali3_solve_lu(ali3_instance *in, int32_t width, const double *F, double *b) {
  if (width == 1)
    solve(in, 1, F, b);
  else
    solve(in, ALI3_RADAU, F, b);
}
