/* Adds payloads to the inertia and inertia forces of the bodies of a tree, after ali3_tree_forces. */
#include "../algebra/small_vectors.h"
#include "tree.h"

/* Adds the inertia about the origin of the earth and the inertia force of a mass at a point of body b. */
static void add_payload(ali3_tree_work *w, int32_t b, double mass, const double *place) {
  double c[3], spin[3], rate[3], v[3], turned[3], relative_acceleration[3], force[3], torque[3];
  for (int i = 0; i < 3; i++) {
    c[i] =
        w->origin[i][b] + (w->frame[b][i][0] * place[0] + w->frame[b][i][1] * place[1] + w->frame[b][i][2] * place[2]);
    spin[i] = w->spin[i][b];
    rate[i] = w->spin_rate[i][b];
  }
  ali3_cross(spin, c, v);
  for (int i = 0; i < 3; i++) v[i] += w->drift[i][b];
  ali3_cross(spin, v, turned);
  ali3_cross(rate, c, relative_acceleration);
  for (int i = 0; i < 3; i++) force[i] = mass * (w->drift_rate[i][b] + relative_acceleration[i] + turned[i]);
  ali3_cross(c, force, torque);
  const double square = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
  for (int i = 0; i < 3; i++) {
    w->force[i][b] += force[i];
    w->torque[i][b] += torque[i];
    w->moment[i][b] += mass * c[i];
    w->inertia[i][b] += mass * (square - c[i] * c[i]);
    w->inertia[3 + i][b] -= mass * c[(i + 1) % 3] * c[(i + 2) % 3];
  }
}

void ali3_tree_payloads(const ali3_instance *in) {
  const ali3_system *S = in->system;
  for (int64_t k = 0; k < S->n_tree_payload_body; k++)
    if (in->parameters.payload_mass[k] > 0.0)
      add_payload(in->tree, S->tree_payload_body[k], in->parameters.payload_mass[k], S->tree_payload_place + 3 * k);
}
