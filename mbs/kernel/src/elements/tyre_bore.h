/* Bore torque of a tyre: friction of the patch against turning about the normal of the road, on a torsion spring of the
 * carcass. A wheel that is steered on the spot turns against it.
 *
 * After G. Rill, Road Vehicle Dynamics, CRC Press, 2011, section 3.7: the patch of length L and width B counts as a
 * circle of radius (L/2 + B/2)/2 under even pressure, on which friction F has the moment R F with R = 2/3 of that
 * radius. Turning by w_n slides the patch by R w_n: T_steady = -g R^2 w_n with a secant damping 1/g = w/K + s/F_y max of
 * cornering stiffness K at the transport speed w and of a patch that slides anyway by s. The carcass psi follows
 * psi'(d + g R^2) = -c psi - g R^2 w_n, T = c psi + d psi', stepped as in tyre.c, so that T (w_n + psi') <= 0. Force and
 * moment share friction: (use of F)^2 + (T/(R F_y max))^2 <= 1, else both are scaled back by the same factor. While a
 * wheel turns on the spot its tyre thus loses hold along and across, as a real one does.
 *
 * s is the slip velocity times the fourth power of F over its steady value: a carcass that bends while its patch sticks
 * must not let the moment of a parked wheel go.
 *
 * States: psi and its rate, behind those of the carcass. The tangent leaves out how T and F change with each other. */
#ifndef ALI3_TYRE_BORE_H
#define ALI3_TYRE_BORE_H
#include "element.h"

enum { ALI3_BORE_STATES = 4 }; /* first of its two slots */
enum { ALI3_BORE_WIDTH, ALI3_BORE_STIFFNESS, ALI3_BORE_DAMPING };

typedef struct {
  const real *numbers; /* width of the patch, m; N m/rad; N m s/rad */
  real lever; /* R, m */
  real rate, row[7]; /* w_n, rad/s, by the rates of the signals of a tyre */
  real moment, C; /* N m; -d moment / d rate */
} ali3_tyre_bore;

/* length: of the patch, m */
ALI3_PER_WIDTH ali3_tyre_bore ali3_tyre_bore_at(const ali3_element_args *a, const real *numbers, const real normal[3],
                                                const real e[3], real length);

typedef struct { /* of the force beside the moment */
  real slope, most; /* cornering stiffness and largest lateral force, N */
  real transport, slip; /* m/s */
  real force, steady; /* its size and that of the steady force at this slip, N */
  real use; /* what it takes of friction, 0 to 1 */
} ali3_tyre_held;

/* One step: moment and new slots. Returns the share of F that is left. */
ALI3_PER_WIDTH real ali3_tyre_bore_step(ali3_element_args *a, ali3_tyre_bore *b, const ali3_tyre_held *by);
#endif
