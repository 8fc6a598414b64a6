/* Assembly modes of closed loops. At each joint between two moving bodies of a loop the arms to the joints before and
 * after it make an angle, seen along an axis n; its sine is zero when the two bodies lie in line. A mode is a
 * combination of signs of sines and cosines that compile found to belong together (mbs/compiler/assembly_modes.py). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../algebra/processor.h"
#include "../elements/signal.h"
#include "../instance.h"
#include "assembly_mode.h"

static const double DEFINITE = 0.15 * 0.15; /* square of a sine or cosine above which a sign counts: as in `compile` */
static const double NOTHING = 1e-24; /* of the squares of the lengths: arms without an angle, along the axis */

enum { SIGNALS = 9, KIND = 9, RING = 10, ITEMS = ALI3_TRIAD_ITEMS };
enum { TURNED = 1, PLANAR = 2 }; /* bits of the kind: from the perpendicular of arm b; n is z, the arms lie across */

ALI3_INLINED double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Signed squares of sine and cosine from numbers proportional to both; 0 where these are nothing beside `lengths`. */
ALI3_INLINED void put(int32_t kind, double ss, double cc, double lengths, double *sine, double *cosine) {
  const double size = fabs(ss) + fabs(cc), scale = size > NOTHING * lengths ? 1.0 / size : 0.0;
  *sine = scale * (kind & TURNED ? cc : ss);
  *cosine = scale * (kind & TURNED ? -ss : cc);
}

/* Signed squares of sine and cosine of the angle from arm a to arm b seen along n. */
ALI3_INLINED void angle(const ali3_system *S, const double *q, const int32_t *t, double *sine, double *cosine) {
  if (t[KIND] & PLANAR) {
    const double ax = ali3_signal_at(S, t[3], q, false), ay = ali3_signal_at(S, t[4], q, false);
    const double bx = ali3_signal_at(S, t[6], q, false), by = ali3_signal_at(S, t[7], q, false);
    const double det = ax * by - ay * bx, c = ax * bx + ay * by;
    put(t[KIND], det * fabs(det), c * fabs(c), 0.0, sine, cosine);
    return;
  }
  double v[SIGNALS];
  const double *n = v, *a = v + 3, *b = v + 6;
  for (int i = 0; i < SIGNALS; i++) v[i] = ali3_signal_at(S, t[i], q, false);
  const double nn = dot(n, n), det = n[0] * (a[1] * b[2] - a[2] * b[1]) + n[1] * (a[2] * b[0] - a[0] * b[2]) +
                                     n[2] * (a[0] * b[1] - a[1] * b[0]);
  const double c = nn * dot(a, b) - dot(n, a) * dot(n, b); /* (n x a) . (n x b) */
  put(t[KIND], nn * det * fabs(det), c * fabs(c), nn * nn * dot(a, a) * dot(b, b), sine, cosine);
}

/* Signed squares of the sines of all triads in in->branch.sine and of the cosines in in->branch.cosine. */
void ali3_mode_angles(ali3_instance *in, const double *q) {
  const int32_t *t = in->system->mode_triad, *end = t + in->system->n_mode_triad;
  for (double *sine = in->branch.sine, *cosine = in->branch.cosine; t < end; t += ITEMS)
    angle(in->system, q, t, sine++, cosine++);
}

/* Bit k if v is positive; marks in *definite whether the sign counts. */
static uint32_t bit(double v, int k, uint32_t *definite) {
  if (fabs(v) >= DEFINITE) *definite |= (uint32_t)1 << k;
  return v > 0.0 ? (uint32_t)1 << k : 0;
}

/* First triad of a loop in none of its modes that differs from the mode that fits best. */
static int32_t misfit(const ali3_system *S, int64_t loop, uint32_t signs, uint32_t definite) {
  uint32_t best = 0;
  int fewest = 2 * ALI3_MAX_TRIADS + 1;
  for (int32_t i = S->mode_cell_ptr[loop]; i < S->mode_cell_ptr[loop + 1]; i += 2) {
    const uint32_t wrong = (signs ^ (uint32_t)S->mode_cell[i]) & (uint32_t)S->mode_cell[i + 1] & definite;
    int count = 0;
    for (uint32_t rest = wrong; rest != 0; rest &= rest - 1) count++;
    if (count < fewest) {
      fewest = count;
      best = wrong;
    }
  }
  int32_t k = 0;
  while ((best >> 2 * k & 3) == 0) k++;
  return k;
}

int32_t ali3_find_mode_misfit(const ali3_instance *in, int64_t loop) {
  const ali3_system *S = in->system;
  const int32_t cell = S->mode_cell_ptr[loop], end = S->mode_cell_ptr[loop + 1],
                first = S->mode_triad_ptr[loop] / ITEMS, n = S->mode_triad_ptr[loop + 1] / ITEMS - first;
  uint32_t signs = 0, definite = 0;
  if (cell == end) return -1;
  for (int32_t k = 0; k < n; k++) {
    signs |= bit(in->branch.sine[first + k], 2 * k, &definite);
    signs |= bit(in->branch.cosine[first + k], 2 * k + 1, &definite);
  }
  for (int32_t i = cell; i < end; i += 2)
    if (((signs ^ (uint32_t)S->mode_cell[i]) & (uint32_t)S->mode_cell[i + 1] & definite) == 0) return -1;
  return misfit(S, loop, signs, definite);
}

/* Appends the name of joint k in quotes, as far as it fits; returns the used length. */
static size_t put_name(const ali3_system *S, int64_t k, char *text, size_t used, size_t size) {
  if (used + 1 < size) text[used++] = '\'';
  for (int32_t i = S->mode_name_ptr[k]; i < S->mode_name_ptr[k + 1] && used + 1 < size; i++)
    text[used++] = (char)S->mode_name[i];
  if (used + 1 < size) text[used++] = '\'';
  text[used] = 0;
  return used;
}

/* Whether joints j and k have the same name. */
static bool same_name(const ali3_system *S, int32_t j, int32_t k) {
  const int32_t *at = S->mode_name_ptr, n = at[j + 1] - at[j];
  return n == at[k + 1] - at[k] && memcmp(S->mode_name + at[j], S->mode_name + at[k], (size_t)n * sizeof *at) == 0;
}

/* Names of the joints of a loop, each once, as many as fit. */
static size_t put_names(const ali3_system *S, int64_t loop, char *text, size_t used, size_t size) {
  const int32_t first = S->mode_triad_ptr[loop] / ITEMS, end = S->mode_triad_ptr[loop + 1] / ITEMS;
  for (int32_t k = first; k < end; k++) {
    bool named = false;
    for (int32_t j = first; j < k; j++) named = named || same_name(S, j, k);
    if (named) continue;
    if (k > first && used + 2 < size) {
      text[used++] = ',';
      text[used++] = ' ';
    }
    used = put_name(S, k, text, used, size);
  }
  return used;
}

ali3_status ali3_branch_text(const ali3_instance *in, char *text, size_t size) {
  if (in == NULL || text == NULL || size < 1) return ALI3_BAD_ARGUMENT;
  const ali3_report *r = &in->report;
  const ali3_system *S = in->system;
  text[0] = 0;
  if (r->branch_changes == 0) return ALI3_OK;
  int n = snprintf(text, size, "At t = %.6g s the closed loop of ", r->branch_time);
  size_t used = n > 0 && (size_t)n < size ? (size_t)n : size - 1;
  used = put_names(S, r->branch_loop, text, used, size);
  if (r->branch_kind == ALI3_BRANCH_JUMP) {
    snprintf(text + used, size - used,
             " changed its assembly mode within one step: the same step in parts ends in another one. The "
             "motion from there on depends on the step; take a shorter one.");
    return ALI3_OK;
  }
  n = snprintf(text + used, size - used, " left its assembly mode at ");
  used = n > 0 && (size_t)n < size - used ? used + (size_t)n : size - 1;
  used = put_name(S, S->mode_triad_ptr[r->branch_loop] / ITEMS + r->branch_triad, text, used, size);
  snprintf(
      text + used, size - used,
      ": the bodies there are now on the other side of the position in which they lie in line. What follows is the "
      "motion of a mechanism assembled otherwise than drawn. End stops would prevent it, or a shorter step if this "
      "one passed over that position.");
  return ALI3_OK;
}
