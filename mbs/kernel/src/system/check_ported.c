/* Checks the map of a System with ports from the coordinates of the same model without them. */
#include "../system.h"
#include "check.h"
#include "loading.h"
#include "message.h"

/* A column for each coordinate without ports; there are not more of these. */
ali3_status ali3_check_ported(const ali3_system *s, ali3_message m) {
  const int64_t n = s->n_ported_ptr - 1;
  return n > s->size.nq ? ali3_bad(m, "%lld coordinates without ports", (long long)n) : ALI3_OK;
}
