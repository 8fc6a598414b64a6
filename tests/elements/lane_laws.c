/* Calls the law of an element for two lanes, with flat arguments: a row for each number, a column for each lane. */
#define ALI3_WIDTH 2
#include "elements/laws.h"

#if defined(_WIN32)
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

enum { MOST = 64 };

static real *of(real *vector, const double *numbers, int32_t n) {
  memcpy(vector, numbers, (size_t)n * sizeof *vector);
  return vector;
}

EXPORT int32_t lanes_have_law(int32_t type) { return law_of(ali3_element_type_get(type)) != NULL; }

/* sizes: nsig, nreal, nint, nstate, nout; weights: h, wC, wK, reach; road: its numbers, then the factor of its friction */
EXPORT void lanes_evaluate(int32_t type, const int32_t sizes[5], const double *u, const double *ud, const double *y,
                           const double weights[4], const double *numbers, const int32_t *integer, const double *input,
                           int32_t road_type, const double *road, double *f, double *S, double *y_new, double *out,
                           double *potential) {
  real vector[6][MOST], made[4][MOST * MOST];
  const ali3_lane_road roads = {.type = road_type,
                                .numbers = of(vector[5], road, ALI3_ROAD_NUMBERS + 1),
                                .friction_factor = vector[5] + ALI3_ROAD_NUMBERS};
  ali3_element_args a = {.nsig = sizes[0],
                         .nreal = sizes[1],
                         .nint = sizes[2],
                         .nstate = sizes[3],
                         .nout = sizes[4],
                         .u = of(vector[0], u, sizes[0]),
                         .ud = of(vector[1], ud, sizes[0]),
                         .y_old = of(vector[2], y, sizes[3]),
                         .y_new = made[2],
                         .h = weights[0],
                         .wC = weights[1],
                         .wK = weights[2],
                         .reach = ali3_same(weights[3]),
                         .real = of(vector[3], numbers, sizes[1]),
                         .integer = integer,
                         .input = of(vector[4], input, 4),
                         .roads = &roads,
                         .f = made[0],
                         .S = made[1],
                         .out = made[3]};
  memset(made, 0, sizeof made);
  law_of(ali3_element_type_get(type))(&a);
  memcpy(f, a.f, (size_t)sizes[0] * sizeof(real));
  memcpy(S, a.S, (size_t)(sizes[0] * sizes[0]) * sizeof(real));
  memcpy(y_new, a.y_new, (size_t)sizes[3] * sizeof(real));
  memcpy(out, a.out, (size_t)sizes[4] * sizeof(real));
  memcpy(potential, &a.potential, sizeof(real));
}
