/* Checks the flexible bodies of a System: coordinates in the fronts, symmetry. */
#include <math.h>

#include "../system.h"
#include "check.h"
#include "loading.h"
#include "message.h"

enum { MAX_SQUARE = 1 << 24 };
static const double SYMMETRY = 1e-9;

/* Every coordinate of the body is in its front at its local index, once, and the modes ascend. */
static ali3_status check_coordinates(const ali3_system *s, int32_t b, ali3_message m) {
  const int32_t first = s->flex_mode_ptr[b], n = s->flex_mode_ptr[b + 1] - first, front = s->flex_front[b];
  const int32_t *idx = s->front_idx + s->front_ptr[front], size = s->front_ptr[front + 1] - s->front_ptr[front];
  const int32_t *loc = s->flex_loc + 12 * (int64_t)b + first, *frame = s->flex_frame + 12 * (int64_t)b;
  const int32_t *mode = s->flex_mode + first;
  if (n < 1) return ali3_bad(m, "flexible body %d has no modes", (int)b);
  for (int32_t i = 0; i < 12 + n; i++) {
    const int32_t coordinate = i < 12 ? frame[i] : mode[i - 12];
    if (loc[i] < 0 || loc[i] >= size || idx[loc[i]] != coordinate)
      return ali3_bad(m, "coordinate %d of flexible body %d is not in front %d", (int)coordinate, (int)b, (int)front);
    if (i > 12 && coordinate <= mode[i - 13]) return ali3_bad(m, "the modes of flexible body %d do not ascend", (int)b);
    if (i >= 12) continue;
    for (int32_t k = 0; k < i; k++)
      if (frame[k] == coordinate) return ali3_bad(m, "a coordinate of flexible body %d appears twice", (int)b);
    if (ali3_find(mode, n, coordinate) >= 0)
      return ali3_bad(m, "a coordinate of flexible body %d appears twice", (int)b);
  }
  return ALI3_OK;
}

/* Checks that the n x n matrix M has M' = sign M. */
static ali3_status check_symmetry(const double *M, int32_t n, double sign, const char *name, int32_t b,
                                  ali3_message m) {
  double largest = 0.0;
  for (int64_t i = 0; i < (int64_t)n * n; i++) largest = fmax(largest, fabs(M[i]));
  for (int32_t i = 0; i < n; i++)
    for (int32_t j = 0; j <= i; j++)
      if (fabs(M[(int64_t)i * n + j] - sign * M[(int64_t)j * n + i]) > SYMMETRY * largest)
        return ali3_bad(m, "'%s' of flexible body %d is not symmetric at (%d, %d)", name, (int)b, (int)i, (int)j);
  return ALI3_OK;
}

ali3_status ali3_check_flexible(ali3_system *s, ali3_message m) {
  const int64_t nb = s->n_flex_front;
  int64_t square = 0;
  for (int64_t b = 0; b < nb; b++) {
    const int64_t n = s->flex_mode_ptr[b + 1] - s->flex_mode_ptr[b];
    square += n * n;
    CHECK(check_coordinates(s, (int32_t)b, m));
  }
  if (square > MAX_SQUARE) return ali3_bad(m, "the flexible bodies have too many modes");
  CHECK(ali3_check_length(m, "flex_T", s->n_flex_T, 9 * square));
  CHECK(ali3_check_length(m, "flex_K", s->n_flex_K, square));
  CHECK(ali3_check_length(m, "flex_C", s->n_flex_C, square));
  square = 0;
  for (int32_t b = 0; b < nb; b++) {
    const int32_t n = s->flex_mode_ptr[b + 1] - s->flex_mode_ptr[b];
    CHECK(check_symmetry(s->flex_K + square, n, 1.0, "flex_K", b, m));
    CHECK(check_symmetry(s->flex_C + square, n, 1.0, "flex_C", b, m));
    for (int p = 0; p < 9; p++)
      CHECK(check_symmetry(s->flex_T + 9 * square + p * (int64_t)n * n, n, p < 6 ? 1.0 : -1.0, "flex_T", b, m));
    square += (int64_t)n * n;
  }
  s->n_flexible = (int32_t)nb;
  return ALI3_OK;
}
