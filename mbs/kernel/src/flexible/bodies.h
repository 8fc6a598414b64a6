/* Bodies beside the constant mass matrix: flexible ones and those by tables. Prepare is for one q, the others use what it
 * left. */
#ifndef ALI3_BODIES_H
#define ALI3_BODIES_H
#include "../instance.h"

void ali3_bodies_prepare(const ali3_instance *in, const double *q);
/* Adds the energy of the weight beside its constant part, and the elastic energy, J. */
void ali3_bodies_energy(const ali3_instance *in, const double *q, double *gravity, double *elastic);
/* F += wM (M(q) - constant part) + wC C + wK K at the q that was prepared; K with the part of the weight. */
void ali3_bodies_tangent(const ali3_instance *in, double wM, double wC, double wK, double *F);
#endif
