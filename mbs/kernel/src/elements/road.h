/* Roads: contacts of a wheel, taken as a disc, and clearances of points. */
#ifndef ALI3_ROAD_H
#define ALI3_ROAD_H
#include <stdint.h>

#include "element.h"

typedef struct ali3_road_file ali3_road_file; /* roads/road_file.h */

#ifndef ALI3_WIDTH
struct ali3_road { /* typedef in element.h */
  int32_t type, nreal; /* ALI3_ROAD_*; length of `real` */
  const double *real; /* as ALI3_ROAD_* lists them: m, earth axes */
  ali3_road_file *file; /* replaces the road's numbers except its friction factor; NULL: none */
  const double *const *input; /* inputs of the System, read by a road at a port */
};
#endif
typedef struct ali3_road ali3_road;

enum { /* `RoadType` in Python is generated from this enum */
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
  /* -normal . down = sine of the angle between wheel axis and normal; limited from below if the wheel is nearly flat on
   * the road */
  real cosine;
  real friction; /* coefficient of the road, including its factor */
  real leaning; /* d(cosine)/d(sine between axis and normal): 1, less if the wheel is nearly flat on the road */
  /* 0 to 1: fraction of the load borne by the other contact, on a grid, where only the deepest bears; otherwise 0 */
  real yielded;
  real switching; /* derivative of that fraction by the difference of both penetrations, 1/m; 0: both bear */
} ali3_contact;

/* Stands for an absent contact: farther than any road. */
static inline ali3_contact ali3_no_contact(void) {
  return (ali3_contact){.penetration = ali3_same(-1e300), .cosine = ali3_same(1.0)};
}

/* Writes one or two contacts, also open ones so that outputs are continuous, and returns their number. `axis` is a unit
 * vector. The distance is C1 in centre and axis; d(-penetration) = normal . d(centre) / cosine. */
ALI3_PER_WIDTH int ali3_road_contacts(const ali3_road *road, const real centre[3], const real axis[3], real radius,
                                      ali3_contact out[2]);

enum { ALI3_ROAD_INPUTS = 7 }; /* inputs of one contact of a road at a port */

/* Returns the type of a road; writes the numbers of a plane or a kerb, otherwise 0, and the factor on the friction. */
enum { ALI3_ROAD_NUMBERS = 5 };
int32_t ali3_road_numbers(const ali3_road *road, double numbers[ALI3_ROAD_NUMBERS], double *friction_factor);

typedef struct {
  double distance; /* distance of a point from the road, m; < 0 below it */
  double gradient[3]; /* gradient of the distance: the unit normal; shorter inside a kerb near its edge */
  double friction; /* as of ali3_contact */
} ali3_clearance;

/* Writes one or two clearances of a point (kerb: step and lower level) and returns their number. */
int ali3_road_clearance(const ali3_road *road, const double point[3], ali3_clearance out[2]);

/* Returns 1 for a grid and writes the spacing of its points in x and y, m. */
int ali3_road_spacing(const ali3_road *road, double spacing[2]);

/* Upper bound of the height of the road, m, within the horizontal distance `reach`, m, of a place. */
double ali3_road_top(const ali3_road *road, const double place[3], double reach);

const char *ali3_road_check(int32_t type, const double *real, int32_t nreal); /* NULL, or the error as one sentence */
#endif
