/* Getting and setting integers, by the functions of real variables; a call with one bad value changes nothing. */
#include <math.h>

#include "slave.h"

/* Whether all are integer variables; if not, an error is logged. */
static bool all_whole(slave *s, const uint32_t *reference, size_t n) {
  const slave_table *t = &slave_the_table;
  for (size_t i = 0; i < n; i++) {
    if (reference[i] >= t->n_variables) {
      slave_log(s, SLAVE_ERROR, "There is no variable with value reference %u.", (unsigned)reference[i]);
      return false;
    }
    if (!t->variable[reference[i]].whole) {
      slave_log(s, SLAVE_ERROR, "'%s' is a real number, not an integer.", t->variable[reference[i]].name);
      return false;
    }
  }
  return true;
}

slave_status slave_get_whole(slave *s, const uint32_t *reference, size_t n, int32_t *value) {
  if (!all_whole(s, reference, n)) return SLAVE_ERROR;
  for (size_t i = 0; i < n; i++) {
    double x;
    const slave_status status = slave_get(s, &reference[i], 1, &x);
    if (status != SLAVE_OK) return status;
    value[i] = (int32_t)fmax(INT32_MIN, fmin(INT32_MAX, nearbyint(x)));
  }
  return SLAVE_OK;
}

slave_status slave_set_whole(slave *s, const uint32_t *reference, size_t n, const int32_t *value) {
  slave_status worst = SLAVE_OK;
  if (!all_whole(s, reference, n)) return SLAVE_ERROR;
  for (int pass = 0; pass < 2; pass++) /* all are checked before one is set */
    for (size_t i = 0; i < n; i++) {
      const double x = value[i];
      const slave_status status = pass == 0 ? slave_check_set(s, reference[i], x) : slave_set(s, &reference[i], 1, &x);
      if (status > SLAVE_WARNING) return status;
      if (status > worst) worst = status;
    }
  return worst;
}
