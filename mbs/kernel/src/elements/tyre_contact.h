/* Contact of tyres of every formula: the disc on its road, the radial spring, the axes and velocities of the patch, the
 * verdict on a start. */
#ifndef ALI3_TYRE_CONTACT_H
#define ALI3_TYRE_CONTACT_H
#include "element.h"

#define ALI3_TYRE_SLOW                                                                                                 \
  1e-5 /* m/s, of the speed that slips refer to; small so that a parked car creeps by micrometres */
#define ALI3_TYRE_ROLLS 1.0 /* m/s, from which effective radius and trail are those of the rolling tyre */
#define ALI3_TYRE_HUB                                                                                                  \
  0.1 /* of the radius: the patch of a wheel that is deeper in the road stays so far from its centre */
#define ALI3_TYRE_NO_LOAD 1e-9 /* N */
#define ALI3_TYRE_NO_GRIP 1e-6 /* of the friction at which the forces of the tyre hold */

/* Bits of the pieces of a tyre's law; those of the second contact lie ALI3_TYRE_CONTACT_BITS higher. */
enum {
  ALI3_TYRE_TOUCHES = 1,
  ALI3_TYRE_BOTTOMS = 2, /* on its bottoming radius */
  ALI3_TYRE_FULLY = 4, /* deep enough for all of its damping */
  ALI3_TYRE_PRESSES = 8,
  ALI3_TYRE_CONTACT_BITS = 4,
  ALI3_TYRE_AT_LIMIT = 1 << 8, /* of adhesion */
  ALI3_TYRE_OVERLOADED = 1 << 9, /* beyond the loads of its curves */
  ALI3_TYRE_AT_RANGE = 1 << 10 /* of slip, slip angle (one bit higher) or camber (two) */
};

typedef struct { /* m, N/m, N/m^2 (force of the squared deflection), N s/m */
  real radius, bottoming_radius, stiffness, progression, damping, bottoming_stiffness;
} ali3_tyre_spring;

typedef struct {
  real load, friction; /* sums or load-weighted means of the contacts */
  real normal[3], rho[3]; /* unit normal; contact patch relative to the wheel centre, in the wheel plane */
  real
      beyond; /* m: depth where the road is nearer to the wheel centre than the patch, which stays on the rim; else 0 */
  real near_normal[3], near_rho[3]; /* of the nearest contact, also in the air */
} ali3_tyre_patch;

typedef struct {
  real forward[3], left[3]; /* unit axes in the road's plane */
  real upright; /* cosine of the inclination */
  real push[3]; /* velocity of the patch per spin */
  real loaded; /* loaded radius, m */
  real travel[2], v[2]; /* velocity of the wheel and slip velocity of the patch along both, m/s */
  real row[2][7]; /* of the slip velocities, by the rates of the signals */
} ali3_tyre_motion;

/* Unit axis of a wheel: an iterate of the solver need not be a unit vector. */
ALI3_PER_WIDTH void ali3_tyre_axis(const real axis[3], real e[3]);

/* Radial forces of all contacts: adds to f, S and potential, returns the mean patch. */
ALI3_PER_WIDTH ali3_tyre_patch ali3_tyre_radial(ali3_element_args *a, const real e[3], const ali3_tyre_spring *spring);

/* Axes at the patch; velocities and rows follow when the slip radius is known. */
ALI3_PER_WIDTH ali3_tyre_motion ali3_tyre_axes(const ali3_tyre_patch *contact, const real e[3]);

/* Share of the rolling tyre at a speed: 0 at rest, 1 from ALI3_TYRE_ROLLS on, with a continuous slope. */
ALI3_PER_WIDTH real ali3_tyre_moving(real speed);

/* `ratio`: slip radius over loaded radius. */
ALI3_PER_WIDTH void ali3_tyre_velocities(const ali3_element_args *a, const ali3_tyre_patch *contact, const real e[3],
                                         real ratio, ali3_tyre_motion *m);

/* The outputs that every tyre begins with, ALI3_TYRE_OUTPUTS in number; `resisting`: of rolling, about the axis. */
enum { ALI3_TYRE_DEFLECTION = 6, ALI3_TYRE_OUTPUTS = 16 };
ALI3_PER_WIDTH void ali3_tyre_outputs(ali3_element_args *a, const ali3_tyre_patch *contact, const real e[3],
                                      const ali3_tyre_motion *m, real radius, real ratio, const real force[2],
                                      real moment, real resisting);

/* Nearest positive semidefinite matrix; C holds xx, xy, yy. */
ALI3_PER_WIDTH void ali3_tyre_semidefinite(real C[3]);

/* Depth of a tyre in its road; its first number is the radius, its first integer the road. */
double ali3_tyre_depth(const ali3_element_args *a, double raised, double *part);
ali3_start_verdict ali3_tyre_start(const ali3_element_args *a, double raised);
#define ALI3_TYRE_START_WORDS "lies deeper in the road than its radius"
#endif
