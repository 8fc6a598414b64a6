/* Parameters of an instance, written to its copies of the data of elements, driving functions, roads, payloads,
 * armatures, bodies, axes and sensors, and to the start states of switches. */
#include "parameters.h"

#include <string.h>

#include "../algebra/real.h"
#include "../instance.h"
#include "../rows/driving_functions.h"
#include "../system/loading.h"
#include "axes.h"
#include "masses.h"

ALI3_BRANCHES_AS_WRITTEN

double ali3_parameter_writes(const ali3_system *S, int64_t k, double value) {
  const bool inverse = S->n_par_inverse > 0 && S->par_inverse[k];
  const double product = inverse ? S->par_scale[k] / value : S->par_scale[k] * value;
  return S->n_par_offset > 0 ? product + S->par_offset[k] : product;
}

/* Arrays of an instance that parameters write, by target. */
typedef struct {
  double *of[ALI3_TARGET_COUNT];
} targets;

/* Arrays that parameters write. */
static targets targets_of(const ali3_instance *in) {
  return (targets){{[ALI3_TARGET_ELEMENT] = in->parameters.el_parameter,
                    [ALI3_TARGET_DRIVING] = in->parameters.guide_parameter,
                    [ALI3_TARGET_ROAD] = in->parameters.road_parameter,
                    [ALI3_TARGET_PAYLOAD] = in->parameters.payload_mass,
                    [ALI3_TARGET_SWITCH] = in->parameters.switch_on,
                    [ALI3_TARGET_ARMATURE] = in->parameters.armature_ratio,
                    [ALI3_TARGET_INERTIA] = in->parameters.inertia_parameter,
                    [ALI3_TARGET_SENSOR] = in->parameters.sen_parameter,
                    [ALI3_TARGET_AXIS] = in->parameters.axis_parameter}};
}

/* Writes the value of parameter p to its targets. */
static void write(ali3_instance *in, int32_t p) {
  const ali3_system *S = in->system;
  const targets target = targets_of(in);
  for (int32_t k = S->par_ptr[p]; k < S->par_ptr[p + 1]; k++)
    target.of[S->par_target[k]][S->par_index[k]] = ali3_parameter_writes(S, k, in->parameters.value[p]);
}

/* Checks target k, or all data if k = -1. */
static const char *check(const ali3_instance *in, int64_t k) {
  const targets target = targets_of(in);
  const double *const *data = (const double *const *)target.of;
  return k < 0 ? ali3_check_data(in->system, data) : ali3_check_target(in->system, k, data);
}

/* Whether parameter p writes to an array of that kind. */
static bool has_target(const ali3_system *S, int32_t p, int32_t family) {
  for (int32_t k = S->par_ptr[p]; k < S->par_ptr[p + 1]; k++)
    if (S->par_target[k] == family) return true;
  return false;
}

void ali3_parameters_switch(ali3_instance *in) {
  const ali3_system *S = in->system;
  for (int64_t k = 0; k < S->n_par_target; k++)
    if (S->par_target[k] == ALI3_TARGET_SWITCH) in->now.on[S->par_index[k]] = in->parameters.switch_on[S->par_index[k]];
}

ali3_status ali3_parameters_apply(ali3_instance *in) {
  for (int32_t p = 0; p < in->system->size.np; p++) write(in, p);
  ali3_driving_measure(in);
  ali3_axes_apply(in);
  ali3_masses_apply(in);
  if (!in->start.initialised) ali3_parameters_switch(in);
  return check(in, -1) == NULL ? ALI3_OK : ALI3_BAD_ARGUMENT;
}

bool ali3_parameters_set_all(ali3_instance *in, const void *values) {
  const size_t size = (size_t)in->system->size.np * sizeof(double);
  memcpy(in->parameters.work, in->parameters.value, size);
  memcpy(in->parameters.value, values, size);
  if (ali3_parameters_apply(in) == ALI3_OK) return true;
  memcpy(in->parameters.value, in->parameters.work, size);
  ali3_parameters_apply(in);
  return false;
}

/* Sets one parameter and checks the data that it writes. */
static ali3_status write_checked(ali3_instance *in, int32_t p, double value) {
  const ali3_system *S = in->system;
  in->parameters.value[p] = value;
  write(in, p);
  if (has_target(S, p, ALI3_TARGET_DRIVING)) ali3_driving_measure(in);
  for (int32_t k = S->par_ptr[p]; k < S->par_ptr[p + 1]; k++)
    if (check(in, k) != NULL) return ALI3_BAD_ARGUMENT;
  return ALI3_OK;
}

/* Whether a value is finite and in the range of its parameter. */
static bool in_range(const ali3_instance *in, int32_t index, double value) {
  return in != NULL && index >= 0 && index < in->system->size.np && value - value == 0.0 &&
         value >= in->system->par_min[index] && value <= in->system->par_max[index];
}

ali3_status ali3_set_parameter(ali3_instance *in, int32_t index, double value) {
  if (!in_range(in, index, value)) return ALI3_BAD_ARGUMENT;
  const double before = in->parameters.value[index];
  if (in->start.initialised && in->system->n_par_fixed > 0 && in->system->par_fixed[index]) return ALI3_FIXED_PARAMETER;
  const ali3_status status = write_checked(in, index, value);
  if (status != ALI3_OK) write_checked(in, index, before);
  in->report.free_states = 0;
  const bool axes = has_target(in->system, index, ALI3_TARGET_AXIS);
  const bool masses = axes || has_target(in->system, index, ALI3_TARGET_PAYLOAD) ||
                      has_target(in->system, index, ALI3_TARGET_ARMATURE) ||
                      has_target(in->system, index, ALI3_TARGET_INERTIA);
  if (status == ALI3_OK && axes) ali3_axes_apply(in);
  if (status == ALI3_OK && masses) ali3_masses_apply(in);
  if (status == ALI3_OK && has_target(in->system, index, ALI3_TARGET_SWITCH)) ali3_parameters_switch(in);
  return status;
}

ali3_status ali3_try_parameter(ali3_instance *in, int32_t index, double value) {
  if (!in_range(in, index, value)) return ALI3_BAD_ARGUMENT;
  const double before = in->parameters.value[index];
  const ali3_status status = write_checked(in, index, value);
  write_checked(in, index, before);
  return status;
}

ali3_status ali3_get_parameter(const ali3_instance *in, int32_t index, double *value) {
  if (in == NULL || value == NULL || index < 0 || index >= in->system->size.np) return ALI3_BAD_ARGUMENT;
  *value = in->parameters.value[index];
  return ALI3_OK;
}
