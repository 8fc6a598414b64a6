/* Rows that are switched on or off: one that is off is a row of zeros, one that is on holds its anchor. */
#include "switch_rows.h"
#include "../instance.h"

bool ali3_row_is_off(const ali3_instance *in, int32_t k) {
  const int32_t number = in->system->row_switch[k];
  return number >= 0 && in->now.on[number] == 0.0;
}

void ali3_switch_rows(const ali3_instance *in, real *Phi, real *J) {
  const ali3_system *S = in->system;
  for (int32_t k = 0; k < S->size.nc; k++) {
    if (S->row_switch[k] < 0) continue;
    if (in->now.on[S->row_switch[k]] != 0.0) {
      Phi[k] -= in->now.anchor[k];
    } else {
      Phi[k] = 0.0;
      for (int32_t i = S->row_ptr[k]; i < S->row_ptr[k + 1]; i++) J[i] = 0.0;
    }
  }
}

void ali3_switch_values(const ali3_instance *in, real *v) {
  const ali3_system *S = in->system;
  for (int32_t k = 0; k < S->size.nc; k++)
    if (ali3_row_is_off(in, k)) v[k] = 0.0;
}
