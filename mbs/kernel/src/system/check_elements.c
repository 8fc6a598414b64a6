/* Checks the force elements of a System. */
#include "../elements/element.h"
#include "../system.h"
#include "check.h"
#include "loading.h"
#include "message.h"

/* Local indices refer to the coordinates of the signals in the element's front. */
static ali3_status check_local_indices(const ali3_system *s, int32_t e, int64_t entries, ali3_message m) {
  const int32_t f = s->el_front[e], n_loc = s->el_loc_ptr[e + 1] - s->el_loc_ptr[e];
  if (n_loc != entries && !(f == -1 && n_loc == 0))
    return ali3_bad(m, "element %d has %d local indices for %lld signal entries", (int)e, (int)n_loc,
                    (long long)entries);
  if (f == -1) return ALI3_OK;
  const int32_t *idx = s->front_idx + s->front_ptr[f], n = s->front_ptr[f + 1] - s->front_ptr[f];
  const int32_t *loc = s->el_loc + s->el_loc_ptr[e];
  for (int32_t i = s->el_sig_ptr[e]; i < s->el_sig_ptr[e + 1]; i++) {
    const int32_t signal = s->el_sig[i];
    for (int32_t k = s->sig_ptr[signal]; k < s->sig_ptr[signal + 1]; k++, loc++)
      if (s->sig_col[k] < s->size.nq && (*loc < 0 || *loc >= n || idx[*loc] != s->sig_col[k]))
        return ali3_bad(m, "coordinate %d of element %d is not in front %d", (int)s->sig_col[k], (int)e, (int)f);
  }
  return ALI3_OK;
}

ali3_status ali3_check_elements(const ali3_system *s, ali3_message m) {
  const int32_t ne = s->size.ne;
  for (int32_t e = 0; e < ne; e++) {
    const ali3_element_type *type = ali3_element_type_get(s->el_type[e]);
    const int32_t nsig = s->el_sig_ptr[e + 1] - s->el_sig_ptr[e],
                  nreal = s->el_parameter_ptr[e + 1] - s->el_parameter_ptr[e],
                  nint = s->el_int_ptr[e + 1] - s->el_int_ptr[e], nout = s->el_out_ptr[e + 1] - s->el_out_ptr[e],
                  nstate = s->el_state_ptr[e + 1] - s->el_state_ptr[e];
    if (type == NULL) return ali3_bad(m, "element %d has the unknown type %d", (int)e, (int)s->el_type[e]);
    if (nsig > ALI3_MAX_SIGNALS ||
        !ali3_element_fits(type, nsig, nreal, s->el_int + s->el_int_ptr[e], nint, nstate, nout))
      return ali3_bad(m, "element %d of type %d has %d signals, %d reals, %d integers, %d states, %d outputs", (int)e,
                      (int)s->el_type[e], (int)nsig, (int)nreal, (int)nint, (int)nstate, (int)nout);
    int64_t entries = 0;
    for (int32_t i = s->el_sig_ptr[e]; i < s->el_sig_ptr[e + 1]; i++)
      entries += s->sig_ptr[s->el_sig[i] + 1] - s->sig_ptr[s->el_sig[i]];
    CHECK(check_local_indices(s, e, entries, m));
  }
  return ALI3_OK;
}
