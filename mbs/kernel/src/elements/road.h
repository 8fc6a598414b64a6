/* Roads: where a wheel, taken as a disc, touches the ground, and how far a point is from it. */
#ifndef ALI3_ROAD_H
#define ALI3_ROAD_H
#include <stdint.h>

#include "element.h"

typedef struct ali3_road_file ali3_road_file; /* roads/road_file.h */

#ifndef ALI3_WIDTH
struct ali3_road { /* typedef in element.h */
  int32_t type, nreal;
  const double *real;
  ali3_road_file *file; /* in place of the road's own numbers, all but its friction factor; NULL: none */
  const double *const *input; /* where the inputs of the System are that a road at a port reads */
};
#endif
typedef struct ali3_road ali3_road;

enum { /* `RoadType` in Python is read from here */
       ALI3_ROAD_PLANE = 0, /* [height at the origin, grade dz/dx, grade dz/dy, friction, its factor or nothing] */
       ALI3_ROAD_KERB, /* [x of the edge, lower height, step height, side, friction, its factor or nothing]; the upper part is at
                          smaller x for side 1, at larger x for -1 */
       ALI3_ROAD_GRID, /* [nx, ny, x0, y0, dx, dy, friction factor, nx*ny heights, nx*ny frictions], y runs fastest */
       ALI3_ROAD_PORT, /* [number of answers, the first of 7 inputs of each: x, y, height, normal (3), friction] */
       ALI3_ROAD_COUNT
};

typedef struct {
  real penetration; /* radius minus distance from the centre to the road in the wheel plane, m; < 0: no contact */
  real point[3]; /* nearest point of the road in the wheel plane, m, earth axes */
  real normal[3]; /* unit normal of the road (of the contact line at an edge), upwards */
  real down[3]; /* unit, in the wheel plane, towards the road: point = centre + (radius - penetration) down */
  real cosine; /* -normal . down = sine of the angle between wheel axis and normal; more, above 0, where the wheel
                    * lies nearly flat */
  real friction;
  real leaning; /* d(cosine)/d(sine between axis and normal): 1, less where the wheel lies nearly flat */
  real yielded; /* part that the other contact has where only the deepest bears, as on a grid: 0 to 1 */
  real switching; /* change of that part with the difference of both penetrations, 1/m; 0: both bear */
} ali3_contact;

/* Farther than any: what stands for a contact of which there is none. */
static inline ali3_contact ali3_no_contact(void) {
  return (ali3_contact){.penetration = ali3_same(-1e300), .cosine = ali3_same(1.0)};
}

/* Writes one or two contacts (also open ones, so that outputs stay continuous) and returns their number.
 * axis must be a unit vector. The distance is C1 in centre and axis; -penetration grows by cosine^-1 normal .
 * d(centre). */
ALI3_PER_WIDTH int ali3_road_contacts(const ali3_road *road, const real centre[3], const real axis[3], real radius,
                                      ali3_contact out[2]);

enum { ALI3_ROAD_INPUTS = 7 }; /* of an answer of a road at a port */

/* Returns the type of a road; writes its numbers if it is a plane or a kerb, and the factor of its friction. */
enum { ALI3_ROAD_NUMBERS = 5 };
int32_t ali3_road_numbers(const ali3_road *road, double numbers[ALI3_ROAD_NUMBERS], double *friction_factor);

typedef struct {
  double distance; /* of a point from the road, m; < 0 below it */
  double gradient[3]; /* of the distance: the unit normal, but shorter within a kerb near its edge */
  double friction;
} ali3_clearance;

/* Writes one or two clearances of a point (kerb: step and lower level) and returns their number. */
int ali3_road_clearance(const ali3_road *road, const double point[3], ali3_clearance out[2]);

/* Whether it is a grid, and the distances of its points, m. */
int ali3_road_spacing(const ali3_road *road, double spacing[2]);

/* No point of the road within `reach` of a place in x and y is higher, m. */
double ali3_road_top(const ali3_road *road, const double place[3], double reach);

const char *ali3_road_check(int32_t type, const double *real, int32_t nreal); /* NULL or one sentence */
#endif
