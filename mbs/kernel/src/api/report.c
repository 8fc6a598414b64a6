/* The report of an instance, with what its energy balance says: the one place that callers in all languages ask. */
#include <math.h>

#include "../instance.h"
#include "../method.h"

/* ALI3_BALANCE_* of the run so far. */
static int32_t balance_of(const ali3_instance *in) {
  const ali3_report *r = &in->report;
  if (!(ali3_energy_balance(r) > ALI3_WRONG_ERROR) || !(fabs(r->energy_error) > r->energy_floor))
    return ALI3_BALANCE_KEPT;
  const bool driven = in->system->n_gterm_row > 0;
  return ali3_method_of(in)->balance_decides && ali3_has_balance(in) && !driven ? ALI3_BALANCE_WRONG
                                                                                : ALI3_BALANCE_OPEN;
}

ali3_status ali3_report_get(const ali3_instance *in, ali3_report *out) {
  if (in == NULL || out == NULL) return ALI3_BAD_ARGUMENT;
  *out = in->report;
  out->balance = balance_of(in);
  return ALI3_OK;
}
