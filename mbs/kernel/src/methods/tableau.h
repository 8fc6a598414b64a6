/* Explicit Runge-Kutta methods as Butcher tableaus. */
#ifndef ALI3_TABLEAU_H
#define ALI3_TABLEAU_H
#include "../instance.h"

typedef struct {
  int32_t stages; /* ALI3_STAGES at most */
  const double *c, *b; /* nodes and weights */
  const double (*a)[ALI3_STAGES]; /* a[i][j], j < i: coefficient of stage j in stage i */
} ali3_tableau;

extern const ali3_tableau ali3_tableau_4; /* order 4: Kutta, the classical rule */
extern const ali3_tableau ali3_tableau_8; /* order 8: Dormand and Prince */
#endif
