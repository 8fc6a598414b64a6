/* Mass, forces and energy of flexible and of lookup-table bodies together. */
#include "bodies.h"
#include "../instance.h"
#include "../lookup/lookup.h"
#include "flexible_body.h"

void ali3_bodies_prepare(const ali3_instance *in, const double *q) {
  ali3_flexible_prepare(in, q);
  if (in->system->n_lookup > 0) ali3_lookup_prepare(in, q);
}

void ali3_bodies_energy(const ali3_instance *in, const double *q, double *gravity, double *elastic) {
  ali3_flexible_energy(in, q, gravity, elastic);
  if (in->system->n_lookup > 0) *gravity += ali3_lookup_gravity(in, q);
}

void ali3_bodies_tangent(const ali3_instance *in, double wM, double wC, double wK, double *F) {
  ali3_flexible_tangent(in, wM, wC, wK, F);
  if (in->system->n_lookup > 0) ali3_lookup_tangent(in, wM, wK, F);
}
