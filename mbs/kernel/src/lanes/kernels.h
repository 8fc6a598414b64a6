/* The sources of a step, compiled for lanes: included once for each width, with ALI3_WIDTH and the instructions that the
 * processor then has. An instance is a group there; what a System without switches never asks for is nothing. */
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

static inline real ALI3_LANED(sine)(real x) {
  for (int l = 0; l < ALI3_WIDTH; l++) x[l] = ali3_sin(x[l]);
  return x;
}

static inline real ALI3_LANED(cosine)(real x) {
  for (int l = 0; l < ALI3_WIDTH; l++) x[l] = ali3_cos(x[l]);
  return x;
}

#define ali3_instance ali3_lane_group
#define ali3_vectors ali3_lane_vectors
#define ali3_sin ALI3_LANED(sine)
#define ali3_cos ALI3_LANED(cosine)
#define ali3_row_is_off(in, row) false
#define ali3_switch_rows(in, Phi, J) ((void)(J))
#define ali3_switch_values(in, v) ((void)(v))
#define ALI3_SWITCH_ROWS_H
#define ali3_mass_times ALI3_LANED(mass_times)
#define ali3_mass_times_both ALI3_LANED(mass_times_both)
#define ali3_constant_mass_times ALI3_LANED(constant_mass_times)
#define ali3_constant_mass_times_both ALI3_LANED(constant_mass_times_both)
#define ali3_factorise ALI3_LANED(factorise)
#define ali3_solve ALI3_LANED(solve)
#define ali3_constraints ALI3_LANED(constraints)
#define ali3_constraint_rate ALI3_LANED(constraint_rate)
#define ali3_constraint_gamma ALI3_LANED(constraint_gamma)
#define ali3_rigid_rows ALI3_LANED(rigid_rows)
#define ali3_flexible_rows ALI3_LANED(flexible_rows)
#define ali3_rigid_gamma ALI3_LANED(rigid_gamma)
#define ali3_flexible_gamma ALI3_LANED(flexible_gamma)
#define ali3_geometric ALI3_LANED(geometric)
#define ali3_rows_square ALI3_LANED(rows_square)
#define ali3_rows_product ALI3_LANED(rows_product)
#define ali3_rows_times ALI3_LANED(rows_times)
#define ali3_rows_times_both ALI3_LANED(rows_times_both)
#define ali3_rows_transposed ALI3_LANED(rows_transposed)
#define ali3_velocity_jacobian ALI3_LANED(velocity_jacobian)
#define ali3_velocity_gamma ALI3_LANED(velocity_gamma)
#define ali3_velocity_values ALI3_LANED(velocity_values)
#define ali3_velocity_middle ALI3_LANED(velocity_middle)
#define ali3_velocity_release ALI3_LANED(velocity_release)
#define ali3_active_signals ALI3_LANED(active_signals)
#define ali3_add_forces ALI3_LANED(add_forces)
#define ali3_elements_tangent ALI3_LANED(elements_tangent)
#define ali3_accelerate ALI3_LANED(accelerate)
#define ali3_rates_closed ALI3_LANED(rates_closed)
#define ali3_project ALI3_LANED(project)
#define ali3_constraint_work ALI3_LANED(constraint_work)
#define ali3_projection_work ALI3_LANED(projection_work)
#define ali3_energy_size ALI3_LANED(energy_size)
#define ali3_lagrange ALI3_LANED(lagrange)
#define ali3_work_ways ALI3_LANED(work_ways)
#define ali3_tabled_table ALI3_LANED(tabled_table)
#define ali3_tabled_prepare ALI3_LANED(tabled_prepare)
#define ali3_tabled_extend ALI3_LANED(tabled_extend)
#define ali3_tabled_way ALI3_LANED(tabled_way)
#define ali3_tabled_forces ALI3_LANED(tabled_forces)
#define ali3_tabled_moments ALI3_LANED(tabled_moments)
#define ali3_tabled_add_inertia ALI3_LANED(tabled_add_inertia)
#define ali3_tabled_mass_times ALI3_LANED(tabled_mass_times)
#define ali3_tabled_inertia_forces ALI3_LANED(tabled_inertia_forces)
#define ali3_tabled_tangent ALI3_LANED(tabled_tangent)
#define ali3_tabled_elements_tangent ALI3_LANED(tabled_elements_tangent)
#define ali3_flexible_prepare ALI3_LANED(flexible_prepare)
#define ali3_flexible_mass_times ALI3_LANED(flexible_mass_times)
#define ali3_flexible_forces ALI3_LANED(flexible_forces)
#define ali3_flexible_tangent ALI3_LANED(flexible_tangent)
#define ali3_defect_correction ALI3_LANED(defect_correction)
#define ali3_elements_defect ALI3_LANED(elements_defect)
#define ali3_history_miss ALI3_LANED(history_miss)
#define ali3_history_smooth ALI3_LANED(history_smooth)
#define ali3_extrapolate ALI3_LANED(extrapolate)

#include "../algebra/fronts.c"
#include "../elements/signals.c"
#include "../flexible/constant_mass.c"
#include "../flexible/flexible_body.c"
#include "../methods/accelerate.c"
#include "../methods/constraint_work.c"
#include "../methods/defect_correction.c"
#include "../methods/extrapolation.c"
#include "../methods/projection.c"
#include "../rows/constraints.c"
#include "../rows/velocity_rows.c"
#include "../state/work_ways.c"
#include "../tabled/table.c"
#include "../tabled/tabled.c"
#include "../tabled/tabled_inertia.c"
#include "../tabled/tabled_tangent.c"

void ali3_mass_times(const ali3_instance *in, const real *x, real *out) {
  ali3_constant_mass_times(in, x, out);
  if (in->system->n_flexible > 0) ali3_flexible_mass_times(in, x, out);
  if (in->system->n_tabled > 0) ali3_tabled_mass_times(in, x, out);
}

void ali3_mass_times_both(const ali3_instance *in, const real *x, const real *y, real *out_x, real *out_y) {
  ali3_constant_mass_times_both(in, x, y, out_x, out_y);
  if (in->system->n_flexible > 0) ali3_flexible_mass_times(in, x, out_x), ali3_flexible_mass_times(in, y, out_y);
  if (in->system->n_tabled > 0) ali3_tabled_mass_times(in, x, out_x), ali3_tabled_mass_times(in, y, out_y);
}

#include "../algebra/lane_copies.h"
#include "lane_step.h"

const ali3_lane_code ALI3_LANED(ali3_code) = {.step = step, .spread = put_side_by_side, .collect = take_apart};

#if defined(__clang__) && defined(ALI3_INSTRUCTIONS)
#pragma clang attribute pop
#endif
#endif
#endif
