/* Ways of the signals whose elements' work a sensor asks for. */
#include "work.h"

void ali3_work_ways(const ali3_instance *in, real *ways) {
  const ali3_system *S = in->system;
  for (int32_t k = 0; k < S->n_work; k++) {
    const int32_t *signal = S->el_sig + S->el_sig_ptr[S->work_element[k]];
    for (int32_t i = S->work_ptr[k]; i < S->work_ptr[k + 1]; i++, signal++) {
      real sum = {0};
      for (int32_t t = S->sig_ptr[*signal]; t < S->sig_ptr[*signal + 1]; t++)
        sum += S->sig_val[t] * in->D[S->sig_col[t]];
      ways[i] = sum;
    }
  }
}
