/* The sources of a step, compiled for lanes: included once for each width, with ALI3_WIDTH and the processor
 * instructions for it. Here ali3_instance is a group of lanes, and functions declared ALI3_PER_WIDTH have one version
 * for each width. Systems of lanes have no switches, so that their functions are empty. */
#ifndef ALI3_KERNELS_H
#define ALI3_KERNELS_H
#ifdef ALI3_WIDTH
#include <math.h>
#include <string.h>

#if defined(__clang__) && defined(ALI3_INSTRUCTIONS)
#pragma clang attribute push(__attribute__((target(ALI3_INSTRUCTIONS))), apply_to = function)
#endif

#include "../elements/laws.h"
#include "group.h"

/* ali3_sin in each lane. */
static inline real lane_sine(real x) {
  for (int l = 0; l < ALI3_WIDTH; l++) x[l] = ali3_sin(x[l]);
  return x;
}

/* ali3_cos in each lane. */
static inline real lane_cosine(real x) {
  for (int l = 0; l < ALI3_WIDTH; l++) x[l] = ali3_cos(x[l]);
  return x;
}

#define ali3_instance ali3_lane_group
#define ali3_vectors ali3_lane_vectors
#define ali3_sin lane_sine
#define ali3_cos lane_cosine
#define ali3_row_is_off(in, row) false
#define ali3_switch_rows(in, Phi, J) ((void)(J))
#define ali3_switch_values(in, v) ((void)(v))
#define ALI3_SWITCH_ROWS_H

#include "../algebra/fronts.c"
#include "../elements/signals.c"
#include "../flexible/constant_mass.c"
#include "../flexible/flexible_body.c"
#include "../lookup/lookup.c"
#include "../lookup/lookup_functions.c"
#include "../lookup/lookup_inertia.c"
#include "../lookup/lookup_tangent.c"
#include "../methods/accelerate.c"
#include "../methods/constraint_work.c"
#include "../methods/defect_correction.c"
#include "../methods/extrapolation.c"
#include "../methods/predict.c"
#include "../methods/projection.c"
#include "../rows/constraints.c"
#include "../rows/row_products.c"
#include "../rows/velocity_rows.c"
#include "../state/signal_displacements.c"

void ali3_mass_times(const ali3_instance *in, const real *x, real *out) {
  ali3_constant_mass_times(in, x, out);
  if (in->system->n_flexible > 0) ali3_flexible_mass_times(in, x, out);
  if (in->system->n_lookup > 0) ali3_lookup_mass_times(in, x, out);
}

#include "../algebra/lane_copies.h"
#include "lane_step.h"

const ali3_lane_code ALI3_CODE = {.step = step, .spread = interleave, .collect = separate};

#if defined(__clang__) && defined(ALI3_INSTRUCTIONS)
#pragma clang attribute pop
#endif
#endif
#endif
