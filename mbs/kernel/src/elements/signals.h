/* Signals, generalised forces and tangents of all elements. */
#ifndef ALI3_SIGNALS_H
#define ALI3_SIGNALS_H
#include "../algebra/real.h"
#include "../instance.h"

/* in->element.u, in->element.ud: values and rates of the signals that elements use, at q and qd (nq and dependents). */
ALI3_PER_WIDTH void ali3_active_signals(ali3_instance *in, const real *q, const real *qd);
/* Q += generalised forces of all elements except idle ones, from their forces f on their signals. */
ALI3_PER_WIDTH void ali3_add_forces(const ali3_instance *in, const real *f, real *Q);
/* F += B' S B of every element, B = d(signals)/d(coordinates), S from the last ali3_forces with a tangent. */
ALI3_PER_WIDTH void ali3_elements_tangent(ali3_instance *in, real *F);
#endif
