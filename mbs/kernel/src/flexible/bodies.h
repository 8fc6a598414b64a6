/* Bodies beyond the constant mass matrix: flexible ones and those by lookup table. */
#ifndef ALI3_BODIES_H
#define ALI3_BODIES_H
#include "../instance.h"

/* Stores what the other functions need at q (nq). */
void ali3_bodies_prepare(const ali3_instance *in, const double *q);
/* Adds the potential energy of gravity except its constant part, and the elastic energy, J, at the prepared q. */
void ali3_bodies_energy(const ali3_instance *in, const double *q, double *gravity, double *elastic);
/* F += wM (M(q) - constant part) + wC C + wK K at the prepared q; K includes the geometric stiffness of gravity. */
void ali3_bodies_tangent(const ali3_instance *in, double wM, double wC, double wK, double *F);
#endif
