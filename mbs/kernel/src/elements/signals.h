/* Signals, generalised forces and tangents of all elements. */
#ifndef ALI3_SIGNALS_H
#define ALI3_SIGNALS_H
#include "../algebra/real.h"
#include "../instance.h"

ALI3_PER_WIDTH void ali3_active_signals(ali3_instance *in, const real *q, const real *qd);
ALI3_PER_WIDTH void ali3_add_forces(const ali3_instance *in, const real *f, real *Q);
ALI3_PER_WIDTH void ali3_elements_tangent(ali3_instance *in, real *F);
#endif
