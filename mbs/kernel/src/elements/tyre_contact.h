/* Contact of tyres of every formula: the disc on its road, the radial spring, the axes and velocities of the patch, the
 * verdict on a start. */
#ifndef ALI3_TYRE_CONTACT_H
#define ALI3_TYRE_CONTACT_H
#include "element.h"

/* m/s, added to the reference speed of the slips; small, so that a parked car creeps by micrometres only */
#define ALI3_TYRE_SLOW 1e-5
#define ALI3_TYRE_ROLLS 1.0 /* m/s: speed above which effective radius and trail are as of a rolling tyre */
/* Of the radius: least distance of the patch from the centre of a wheel that is deeper in the road. */
#define ALI3_TYRE_HUB 0.1
#define ALI3_TYRE_NO_LOAD 1e-9 /* N */
#define ALI3_TYRE_NO_GRIP 1e-6 /* friction ratio below which the horizontal forces are 0 */

enum { ALI3_TYRE_LOAD = 2, ALI3_TYRE_FORCES }; /* output that is the load, and number of forces, the first outputs */

/* Bits of the active pieces of a tyre's force law; those of the second contact are shifted by
 * ALI3_TYRE_CONTACT_BITS. */
enum {
  ALI3_TYRE_TOUCHES = 1,
  ALI3_TYRE_BOTTOMS = 2, /* on its bottoming radius */
  ALI3_TYRE_FULLY = 4, /* at its full damping */
  ALI3_TYRE_PRESSES = 8,
  ALI3_TYRE_CONTACT_BITS = 4,
  ALI3_TYRE_AT_LIMIT = 1 << 8, /* of adhesion */
  ALI3_TYRE_OVERLOADED = 1 << 9, /* load above the range of its curves */
  ALI3_TYRE_AT_RANGE = 1 << 10 /* of slip, slip angle (one bit higher) or camber (two) */
};

typedef struct { /* m, N/m, N/m^2 (force of the squared deflection), N s/m */
  real radius, bottoming_radius, stiffness, progression, damping, bottoming_stiffness;
} ali3_tyre_spring;

typedef struct {
  real load, friction; /* sums or load-weighted means of the contacts */
  real normal[3], rho[3]; /* unit normal; contact patch relative to the wheel centre, in the wheel plane */
  real beyond; /* m: depth of a road nearer to the wheel's centre than ALI3_TYRE_HUB allows the patch; otherwise 0 */
  real near_normal[3], near_rho[3]; /* normal and patch of the nearest contact, also in the air */
} ali3_tyre_patch;

typedef struct {
  real forward[3], left[3]; /* unit axes in the road's plane */
  real upright; /* cosine of the inclination */
  real push[3]; /* velocity of the patch per rate of the spin, m */
  real loaded; /* loaded radius, m */
  real travel[2], v[2]; /* velocity of the wheel and slip velocity of the patch, both along forward and left, m/s */
  real row[2][7]; /* derivatives of the slip velocities by the rates of the signals */
} ali3_tyre_motion;

/* Unit axis of a wheel; in an iterate of the solver `axis` may not have length 1. */
ALI3_PER_WIDTH void ali3_tyre_axis(const real axis[3], real e[3]);

/* Radial forces of all contacts: adds to f, S and potential, returns the mean patch. */
ALI3_PER_WIDTH ali3_tyre_patch ali3_tyre_radial(ali3_element_args *a, const real e[3], const ali3_tyre_spring *spring);

/* Axes of the patch; velocities and rows are set by ali3_tyre_velocities. */
ALI3_PER_WIDTH ali3_tyre_motion ali3_tyre_axes(const ali3_tyre_patch *contact, const real e[3]);

/* Weight of rolling at a speed, m/s: 0 at rest, 1 above ALI3_TYRE_ROLLS, with a continuous slope. */
ALI3_PER_WIDTH real ali3_tyre_moving(real speed);

/* Sets m->travel, m->v and m->row; ratio: slip radius over loaded radius. */
ALI3_PER_WIDTH void ali3_tyre_velocities(const ali3_element_args *a, const ali3_tyre_patch *contact, const real e[3],
                                         real ratio, ali3_tyre_motion *m);

/* Adds the horizontal force F, N, along forward and left to f, and its damping C = -dF/dv, N s/m, as xx, xy, yy to S */
ALI3_PER_WIDTH void ali3_tyre_add_force(ali3_element_args *a, const ali3_tyre_motion *m, const real F[2],
                                        const real C[3]);

/* Writes the outputs of tyre_fields.h, the first of all tyres: radius: free, m; ratio: slip radius over loaded
 * radius; force: along forward and left, N; moment: about the normal, resisting: of rolling resistance about the axis,
 * N m. */
ALI3_PER_WIDTH void ali3_tyre_outputs(ali3_element_args *a, const ali3_tyre_patch *contact, const real e[3],
                                      const ali3_tyre_motion *m, real radius, real ratio, const real force[2],
                                      real moment, real resisting);

/* Depth of a tyre in its road, m, if it were higher by `raised`; *share: cosine at the deepest contact. Its first
 * number is the radius, its first integer the road. */
double ali3_tyre_depth(const ali3_element_args *a, double raised, double *share);
/* Verdict on a start with the scene raised by `raised`, m: refused with the centre below the road, where the spring of
 * the tyre would throw the scene up. The rise is the depth along the road's normal; at a wall it is repeated. */
ali3_start_verdict ali3_tyre_start(const ali3_element_args *a, double raised);
#define ALI3_TYRE_START_WORDS "lies deeper in the road than its radius"
#endif
