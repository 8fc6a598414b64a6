/* Forces of all elements and flexible bodies, and their tangents. */
#ifndef ALI3_FORCES_H
#define ALI3_FORCES_H
#include "../instance.h"

typedef struct {
  const double *q, *qd, *y_old;
  double h, wC, wK, reach;
  bool tangent;
  bool discrete; /* over a step from in->now, by discrete gradients if an element has them */
  bool iterate; /* one of several iterates: in->watch.now is not updated */
  double *Q, *y_new, *out, *potential;
} ali3_force_call;
void ali3_forces(ali3_instance *in, const ali3_force_call *call);
void ali3_elements_forces(ali3_instance *in, const ali3_force_call *call);
void ali3_forces_tangent(ali3_instance *in, double *F);
bool ali3_element_forces(ali3_instance *in, const ali3_force_call *call, int32_t e, const double *u, const double *ud,
                         double *f, double *tangent);
void ali3_element_accept(ali3_instance *in, const ali3_force_call *call, int32_t e, const double *u, const double *ud);
void ali3_forces_accept(ali3_instance *in, const ali3_force_call *call);
#endif
