/* Explicit Runge-Kutta methods as tables of coefficients. */
#ifndef ALI3_TABLEAU_H
#define ALI3_TABLEAU_H
#include "../instance.h"

typedef struct {
  int32_t stages;
  const double *node, *weight;
  const double (*stage_weight)[ALI3_STAGES];
} ali3_tableau;

extern const ali3_tableau ali3_order_4, ali3_order_8;
#endif
