/* Defects: changes of element forces that their tangents do not include. */
#ifndef ALI3_DEFECT_H
#define ALI3_DEFECT_H
#include "../algebra/real.h"
#include "../instance.h"
#include "element.h"

/* r = -wK (change of element forces since the iterate, whose signals have the rates in->element.ud_at) - B' S times the
 * change of their signals to the changes of q and qd, where S are the tangents in F. Changes of signals are computed
 * from rates, as differences of large positions lose digits. */
ALI3_PER_WIDTH void ali3_elements_defect(ali3_instance *in, double h, lane_mask lanes, const real *q, const real *qd,
                                         real *r);

/* Adds the defect of element e with rates ud of its signals and forces f to r. */
static inline void ali3_add_defect(const ali3_instance *in, int32_t e, const real *ud, const real *f, real *r) {
  const ali3_system *S = in->system;
  const int32_t *signal = S->el_sig + S->el_sig_ptr[e], n = S->el_sig_ptr[e + 1] - S->el_sig_ptr[e];
  const real *before = in->element.force + S->el_sig_ptr[e], *row = in->element.S_made + S->el_S_off[e];
  real change[ALI3_MAX_SIGNALS];
  for (int32_t i = 0; i < n; i++) change[i] = (ud[i] - in->element.ud_at[signal[i]]) / in->rule.rate;
  for (int32_t i = 0; i < n; i++, row += n) {
    real defect = -in->rule.c * (f[i] - before[i]);
    for (int32_t j = 0; j < n; j++) defect -= row[j] * change[j];
    for (int32_t k = S->sig_ptr[signal[i]]; k < S->sig_ptr[signal[i] + 1]; k++)
      r[S->sig_col[k]] += S->sig_val[k] * defect;
  }
}
#endif
