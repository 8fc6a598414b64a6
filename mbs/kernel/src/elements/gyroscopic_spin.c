/* Gyroscopic moment -I Omega d(f x g)/dt on the carrier of an axisymmetric wheel that is reduced to its spin: the rate
 * of its angular momentum I Omega (f x g), without the part I Omega' along the axis, which belongs to the spin. Its
 * generalised forces are -I Omega g' on f and I Omega f' on g, which do no work.
 * f and g are orthonormal on the carrier with f x g along the axis, the rate Omega of the spin is absolute. */
#include "element.h"
#include "gyroscopic_spin_fields.h"

static void evaluate(ali3_element_args *a) {
  const real inertia = a->real[SPIN_INERTIA], momentum = inertia * a->ud[6];
  for (int i = 0; i < 3; i++) {
    a->f[i] = -momentum * a->ud[3 + i];
    a->f[3 + i] = momentum * a->ud[i];
    if (!a->S) continue; /* the coupling of f and g is antisymmetric, that with chi has a symmetric half */
    a->S[i * 7 + 6] = a->S[6 * 7 + i] = 0.5 * a->wC * inertia * a->ud[3 + i];
    a->S[(3 + i) * 7 + 6] = a->S[6 * 7 + 3 + i] = -0.5 * a->wC * inertia * a->ud[i];
  }
  a->potential = ali3_same(0.0);
}

#ifndef ALI3_WIDTH
const ali3_element_type ali3_gyroscopic_spin = {
    ALI3_GYROSCOPIC_SPIN,
    .evaluate = evaluate,
    .conservative = true,
};
#endif
