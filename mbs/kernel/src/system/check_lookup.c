/* Checks lookup-table bodies and numbers of a System: their sizes here, before signals refer to them; the rest with the
 * fronts. */
#include "../lookup/lookup.h"
#include "check.h"
#include "loading.h"
#include "message.h"

enum { MAX_LOOKUPS = 4096, MIN_POINTS = 4, MAX_POINTS = 4096 }; /* control points along a parameter */

ali3_status ali3_check_lookup_sizes(ali3_system *s, ali3_message m) {
  const int64_t n = s->n_tabled_size / 3;
  int64_t coefficients = 0;
  if (n > MAX_LOOKUPS) return ali3_bad(m, "%lld lookup-table bodies and numbers", (long long)n);
  for (int64_t i = 0; i < n; i++) {
    const int32_t *size = s->tabled_size + 3 * i;
    const bool single = size[2] == 1;
    if ((size[0] != 1 && size[0] != ALI3_LOOKUP_BODY) || size[1] < MIN_POINTS || size[1] > MAX_POINTS ||
        (!single && (size[2] < MIN_POINTS || size[2] > MAX_POINTS)))
      return ali3_bad(m, "table %lld has %d functions at %d by %d points", (long long)i, (int)size[0], (int)size[1],
                      (int)size[2]);
    s->n_dependent += size[0];
    coefficients += (int64_t)size[0] * size[1] * size[2];
  }
  CHECK(ali3_check_length(m, "tabled_coef", s->n_tabled_coef, coefficients));
  for (int64_t i = 0; i < n; i++) {
    const int32_t *frame = s->tabled_frame + 12 * i, *param = s->tabled_param + 2 * i;
    for (int k = 1; k < 12; k++)
      if ((frame[k] < 0) != (frame[0] < 0))
        return ali3_bad(m, "table %lld names only some coordinates of a base", (long long)i);
    if (param[0] < 0 || (param[1] < 0) != (s->tabled_size[3 * i + 2] == 1))
      return ali3_bad(m, "table %lld lacks a parameter", (long long)i);
    if (!(s->tabled_axis[4 * i + 1] > 0.0 && s->tabled_axis[4 * i + 3] > 0.0))
      return ali3_bad(m, "the points of table %lld do not ascend", (long long)i);
    if (!(s->tabled_mass[ALI3_LOOKUP_MOMENTS * i] >= 0.0))
      return ali3_bad(m, "the mass of table %lld is negative", (long long)i);
  }
  s->n_lookup = (int32_t)n;
  if (n > 0 && (s->n_tree_parent > 0 || s->n_flex_front > 0))
    return ali3_bad(m, "lookup-table bodies are combined with a tree or flexible bodies");
  return ALI3_OK;
}

ali3_status ali3_check_independent(const ali3_system *s, int32_t signal, const char *what, ali3_message m) {
  for (int32_t k = s->sig_ptr[signal]; k < s->sig_ptr[signal + 1]; k++)
    if (s->sig_col[k] >= s->size.nq) return ali3_bad(m, "%s is on a lookup-table body", what);
  return ALI3_OK;
}
