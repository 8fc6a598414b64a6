/* Of a System with ports: its coordinates by those of the same model without them. */
#include "../system.h"
#include "check.h"
#include "loading.h"
#include "message.h"

/* A column for each coordinate without ports; there are not more of these. */
ali3_status ali3_check_ported(const ali3_system *s, ali3_message m) {
  const int64_t n = s->n_ported_ptr - 1;
  CHECK(ali3_check_length(m, "ported_val", s->n_ported_val, s->n_ported_row));
  CHECK(ali3_check_length(m, "ported_const", s->n_ported_const, n < 0 ? 0 : s->size.nq));
  if (n < 0) return ali3_check_length(m, "ported_row", s->n_ported_row, 0);
  if (n > s->size.nq) return ali3_bad(m, "%lld coordinates without ports", (long long)n);
  CHECK(ali3_check_pointers(m, "ported_ptr", s->ported_ptr, s->n_ported_ptr, n, s->n_ported_row));
  return ali3_check_indices(m, "ported_row", s->ported_row, s->n_ported_row, 0, s->size.nq);
}
