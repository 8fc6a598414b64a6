/* Displacements over a step of the signals of elements whose work is sensed. */
#include "../algebra/number_pairs.h"
#include "../lookup/lookup.h"
#include "work.h"

void ali3_signal_displacements(const ali3_instance *in, real *displacement) {
  const ali3_system *S = in->system;
  const real *D = in->step.D;
  if (S->n_lookup > 0) {
    ali3_lookup_displacements(in, D);
    D = in->lookup.extended[0];
  }
  for (int32_t k = 0; k < S->n_work; k++) {
    const int32_t *signal = S->el_sig + S->el_sig_ptr[S->work_element[k]];
    for (int32_t i = S->work_ptr[k]; i < S->work_ptr[k + 1]; i++, signal++) {
      real sum = {0};
      ALI3_SHORT
      for (int32_t t = S->sig_ptr[*signal]; t < S->sig_ptr[*signal + 1]; t++) sum += S->sig_val[t] * D[S->sig_col[t]];
      displacement[i] = sum;
    }
  }
}
