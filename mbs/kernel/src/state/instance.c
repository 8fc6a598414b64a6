/* Instances: memory, settings, inputs, start position and velocity. */
#include <math.h>
#include <string.h>

#include "../algebra/elementary.h"
#include "../algebra/finite.h"
#include "../elements/road.h"
#include "../instance.h"
#include "../rows/driving_functions.h"
#include "../tree/tree.h"
#include "masses.h"
#include "parameters.h"
#include "road_files.h"
#include "vectors.h"
#include "workspace.h"

uint32_t ali3_version(void) { return ALI3_SYSTEM_VERSION; }

size_t ali3_instance_size(const ali3_system *s) {
  ali3_instance placed;
  ali3_pool pool = {.block = NULL, .used = 0};
  if (s == NULL) return 0;
  ali3_pool_items(&pool, 1, sizeof placed);
  ali3_workspace_place(s, &placed, &pool);
  return pool.used;
}

ali3_status ali3_instance_new(const ali3_system *s, ali3_instance **out) {
  if (s == NULL || out == NULL) return ALI3_BAD_ARGUMENT;
  *out = NULL;
  ali3_pool pool = {.block = s->memory.allocate(1, ali3_instance_size(s)), .used = 0};
  if (pool.block == NULL) return ALI3_NO_MEMORY;
  ali3_instance *in = ali3_pool_items(&pool, 1, sizeof *in);
  ali3_workspace_place(s, in, &pool);
  in->system = in->base = s;
  in->release = s->memory.release;
  in->roads.n = s->nr;
  in->stored.n = ali3_vector_count(s);
  in->inputs.forces = in->inputs.set;
  ali3_masses_start(in);
  if (s->tree != NULL) ali3_tree_start(s, in->tree);
  const ali3_status status = ali3_reset(in);
  if (status != ALI3_OK) {
    in->release(in);
    return status;
  }
  *out = in;
  return ALI3_OK;
}

void ali3_instance_free(ali3_instance *in) {
  if (in == NULL) return;
  ali3_roads_close(in);
  in->release(in);
}

ali3_settings ali3_default_settings(void) {
  const ali3_settings settings = {.alpha = 0.0,
                                  .eps_rel = 1e-7,
                                  .tolerance_r = 1e-10,
                                  .tolerance_phi = 1e-11,
                                  .rho_infinity = 0.8,
                                  .max_iterations = 30,
                                  .max_halvings = 8,
                                  .project = 1,
                                  .update = ALI3_UPDATE_LINEARISED,
                                  .geometric = 1,
                                  .method = ALI3_METHOD_ALI3P,
                                  .predictor = ALI3_PREDICTOR_PARABOLA,
                                  .step_iterations = 0,
                                  .part_ratio = 1.0};
  return settings;
}

/* A limit of iterations requires the augmented Lagrangian, whose iterates can be accepted before convergence. */
static bool limit_valid(const ali3_settings *s) {
  return s->step_iterations == 0 || (s->step_iterations > 0 && s->step_iterations <= 1000 &&
                                     (s->method == ALI3_METHOD_ALI3P || s->method == ALI3_METHOD_GENERALISED_ALPHA));
}

bool ali3_settings_valid(const ali3_settings *s) {
  return limit_valid(s) && s->part_ratio > 0.0 && s->part_ratio < 1e300 && s->alpha >= 0.0 && s->alpha < 1e300 &&
         s->eps_rel > 0.0 && s->eps_rel < 1e300 && s->tolerance_r > 0.0 && s->tolerance_r < 1e300 &&
         s->tolerance_phi > 0.0 && s->tolerance_phi < 1e300 && s->max_iterations >= 1 && s->max_iterations <= 1000 &&
         s->max_halvings >= 0 && s->max_halvings <= 16 && (s->project == 0 || s->project == 1) &&
         (s->update == ALI3_UPDATE_LINEARISED || s->update == ALI3_UPDATE_PAPER) &&
         (s->geometric == 0 || s->geometric == 1) && s->rho_infinity >= 0.0 && s->rho_infinity <= 1.0 &&
         s->method >= 0 && s->method < ALI3_METHOD_COUNT && s->predictor >= 0 && s->predictor < ALI3_PREDICTOR_COUNT;
}

static void copy(double *to, const double *from, int64_t n) {
  if (n > 0) memcpy(to, from, (size_t)n * sizeof(double));
}

ali3_status ali3_reset(ali3_instance *in) {
  if (in == NULL) return ALI3_BAD_ARGUMENT;
  const ali3_system *S = in->system;
  const ali3_report no_report = {0};
  in->settings = ali3_default_settings();
  in->report = no_report;
  in->clock.base = in->clock.h = 0.0;
  in->clock.count = 0;
  in->start.initialised = 0;
  in->inputs.function = NULL;
  in->inputs.n_breaks = 0;
  in->branch.known = false;
  in->start.placed = ALI3_PLACED_BY_FILE;
  in->start.moved = false;
  in->start.to_lift = true;
  in->start.lift = in->start.uneven = 0.0;
  ali3_file_start(in);
  memset(in->now.q, 0, in->stored.n * sizeof(double));
  copy(in->now.q, S->q0, S->size.nq);
  copy(in->now.qd, S->qd0, S->size.nq);
  copy(in->now.y, S->y0, S->size.ny);
  for (int32_t k = 0; k < S->size.n_switch; k++)
    in->now.on[k] = in->parameters.switch_on[k] = (double)S->switch_start[k];
  copy(in->inputs.set, S->input_start, S->size.nu);
  copy(in->now.used, S->input_start, S->size.nu);
  copy(in->parameters.value, S->par_value, S->size.np);
  copy(in->parameters.el_parameter, S->el_parameter, S->n_el_parameter);
  copy(in->parameters.guide_parameter, S->guide_parameter, S->n_guide_parameter);
  ali3_driving_measure(in);
  copy(in->parameters.road_parameter, S->road_parameter, S->n_road_parameter);
  copy(in->parameters.payload_mass, S->payload_mass, S->n_payload_mass);
  copy(in->parameters.armature_ratio, S->armature_ratio, S->n_armature_ratio);
  copy(in->parameters.inertia_parameter, S->inertia_parameter, S->n_inertia_parameter);
  copy(in->parameters.axis_parameter, S->axis_parameter, S->n_axis_parameter);
  copy(in->parameters.sen_parameter, S->sen_parameter, S->n_sen_parameter);
  for (int32_t g = 0; g < S->size.ng; g++)
    if (ali3_driving_filters(S->guide_type[g]))
      in->now.s[g] = in->parameters.guide_parameter[S->guide_parameter_ptr[g] + 2];
  for (int32_t r = 0; r < S->nr; r++) {
    const ali3_road road = {.type = S->road_type[r],
                            .nreal = S->road_parameter_ptr[r + 1] - S->road_parameter_ptr[r],
                            .real = in->parameters.road_parameter + S->road_parameter_ptr[r],
                            .file = in->roads.used[r].file,
                            .input = &in->inputs.forces};
    in->roads.used[r] = in->roads.own[r] = road;
    in->roads.own[r].file = NULL;
    in->roads.own[r].input = &S->input_start; /* the drawing refers to the start values of the inputs */
  }
  return ali3_parameters_apply(in);
}

/* Sets an input, limited to its range. */
ali3_status ali3_set_input(ali3_instance *in, int32_t index, double value) {
  if (in == NULL || index < 0 || index >= in->system->size.nu || !(value - value == 0.0)) return ALI3_BAD_ARGUMENT;
  in->inputs.set[index] = fmax(in->system->input_min[index], fmin(in->system->input_max[index], value));
  return ALI3_OK;
}

ali3_status ali3_get_input(const ali3_instance *in, int32_t index, double *value) {
  if (in == NULL || value == NULL || index < 0 || index >= in->system->size.nu) return ALI3_BAD_ARGUMENT;
  *value = in->inputs.set[index];
  return ALI3_OK;
}

ali3_status ali3_set_pose(ali3_instance *in, const double *pose) {
  if (in == NULL || pose == NULL || !in->system->size.has_pose || !ali3_finite(pose, ALI3_POSE))
    return ALI3_BAD_ARGUMENT;
  const double x = pose[0], y = pose[1], z = pose[2], yaw = pose[3], speed = pose[4], lateral_speed = pose[5],
               rate = pose[6];
  if (fmax(fabs(x), fmax(fabs(y), fabs(z))) > ALI3_FARTHEST) return ALI3_TOO_FAR;
  if (fmax(fmax(fabs(speed), fabs(lateral_speed)), fmax(fabs(yaw), fabs(rate))) > ALI3_FASTEST) return ALI3_TOO_FAR;
  const ali3_system *S = in->system;
  const double c = ali3_cos(yaw), s = ali3_sin(yaw);
  for (int32_t i = 0; i < S->size.nq; i++) {
    in->now.q[i] = in->start.pose_0[i] + c * in->start.pose_cos[i] + s * in->start.pose_sin[i] + x * S->pose_x[i] +
                   y * S->pose_y[i] + z * S->pose_z[i];
    in->now.qd[i] = speed * (c * S->pose_x[i] + s * S->pose_y[i] + S->pose_speed[i]);
    if (lateral_speed != 0.0) in->now.qd[i] += lateral_speed * (c * S->pose_y[i] - s * S->pose_x[i]);
    if (rate != 0.0) in->now.qd[i] += rate * (c * in->start.pose_sin[i] - s * in->start.pose_cos[i]);
  }
  memmove(in->start.pose, pose, sizeof in->start.pose);
  in->start.placed = ALI3_PLACED_BY_POSE;
  in->start.to_lift = true;
  in->start.initialised = 0;
  return ALI3_OK;
}

ali3_status ali3_set_q(ali3_instance *in, const double *q, const double *qd) {
  if (in == NULL) return ALI3_BAD_ARGUMENT;
  const int32_t nq = in->system->size.nq;
  if ((q != NULL && !ali3_finite(q, nq)) || (qd != NULL && !ali3_finite(qd, nq))) return ALI3_BAD_ARGUMENT;
  if (q != NULL) {
    copy(in->now.q, q, nq);
    in->start.placed = ALI3_PLACED_BY_Q;
    in->start.to_lift = false;
  }
  if (qd != NULL) copy(in->now.qd, qd, nq);
  in->start.initialised = 0;
  return ALI3_OK;
}
