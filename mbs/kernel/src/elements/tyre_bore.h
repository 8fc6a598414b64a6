/* Bore torque of a tyre: friction of the patch against rotation about the road's normal, on a torsion spring of the
 * carcass. It resists steering at standstill.
 *
 * After G. Rill, Road Vehicle Dynamics, CRC Press, 2011, section 3.7: a patch of length L and width B is replaced by a
 * circle of radius (L/2 + B/2)/2 under uniform pressure, on which friction F has the moment R F with R = 2/3 of that
 * radius. A rotation at w_n slides the patch at R w_n: T_steady = -g R^2 w_n with 1/g = w/K + s/F_y max, of cornering
 * stiffness K at the transport speed w and of a patch that already slides at s. The carcass psi follows psi'(d + g R^2)
 * = -c psi - g R^2 w_n, T = c psi + d psi', integrated as in tyre_carcass.h, so that T (w_n + psi') <= 0. Force and
 * moment share friction: (utilisation by F)^2 + (T/(R F_y max))^2 <= 1, otherwise both are scaled by the same factor.
 * So a tyre loses longitudinal and lateral grip while its wheel is steered at standstill.
 *
 * s is the slip velocity times the fourth power of F / (steady F): while the carcass deflects and the patch sticks, the
 * moment of a parked wheel must not decay.
 *
 * States: psi and its rate, after the states of the carcass. The tangent neglects the coupling of T and F. */
#ifndef ALI3_TYRE_BORE_H
#define ALI3_TYRE_BORE_H
#include "element.h"
#include "tyre_carcass.h"

enum { ALI3_BORE_STATES = 4 }; /* index of the first of its two states */
enum { ALI3_BORE_WIDTH, ALI3_BORE_STIFFNESS, ALI3_BORE_DAMPING };

typedef struct {
  const real *numbers; /* width of the patch, m; N m/rad; N m s/rad */
  real lever; /* R, m */
  real rate, row[7]; /* w_n, rad/s; its row by the rates of the signals of a tyre */
  real moment, C; /* N m; -d moment / d rate */
} ali3_tyre_bore;

/* Lever, rate and row of the bore torque; `length` of the patch, m. */
ALI3_PER_WIDTH ali3_tyre_bore ali3_tyre_bore_at(const ali3_element_args *a, const real *numbers, const real normal[3],
                                                const real e[3], real length);

/* Horizontal force that acts with the moment. */
typedef struct {
  real slope, most; /* cornering stiffness and largest lateral force, N */
  real transport, slip; /* m/s */
  real force, steady; /* magnitudes of the force and of the steady force at this slip, N */
  real use; /* utilisation of friction by the force, 0 to 1 */
} ali3_tyre_horizontal_force;

/* One step: moment and new states; scales the horizontal force and its derivatives by the shared friction. */
ALI3_PER_WIDTH void ali3_tyre_bore_step(ali3_element_args *a, ali3_tyre_bore *b, const ali3_tyre_horizontal_force *by,
                                        ali3_tyre_force *force);

/* Energy of its spring at the end of the step, J. */
ALI3_PER_WIDTH real ali3_tyre_bore_energy(const ali3_element_args *a, const ali3_tyre_bore *b);
#endif
