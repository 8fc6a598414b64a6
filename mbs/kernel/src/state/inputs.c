/* Inputs within a step. Values set by the caller are interpolated linearly to those given for the end of the step,
 * or constant; a function of time is called at each time: after a jump at the start of the step, before a jump at
 * its end. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "../algebra/finite.h"
#include "../instance.h"
#include "inputs.h"
#include "road_files.h"

static const double NEAR = 1e-9; /* of a step: tolerance for a part that ends at its end */
/* Relative round-off between a value reached by interpolation and the same value set again, or read from a table on
 * either side of a time. */
static const double ROUND_OFF = 1e-13;

/* Checks that inputs (nu) give the roads at ports valid normals. */
static ali3_status check_normals(ali3_instance *in, const double *input) {
  const double *const used = in->inputs.forces;
  in->inputs.forces = input;
  const ali3_status status = ali3_roads_normals(in);
  in->inputs.forces = used;
  return status;
}

/* Calls the input function at time t and writes its values to `to` (nu), limited to their ranges. */
static ali3_status call_function(ali3_instance *in, double t, bool after, double *to) {
  const ali3_system *S = in->system;
  memcpy(in->inputs.work, in->inputs.set, (size_t)S->size.nu * sizeof(double));
  const ali3_float_control host = in->inputs.host_control;
  ali3_float_control_restore(host);
  const int32_t refused = in->inputs.function(in->inputs.context, t, after ? 1 : 0, in->inputs.work);
  ali3_float_control_set();
  in->inputs.host_control = host;
  if (refused != 0) return ALI3_BAD_ARGUMENT;
  if (!ali3_finite(in->inputs.work, S->size.nu)) return ALI3_BAD_ARGUMENT;
  for (int32_t i = 0; i < S->size.nu; i++) to[i] = fmax(S->input_min[i], fmin(S->input_max[i], in->inputs.work[i]));
  return check_normals(in, to);
}

ali3_status ali3_inputs_set_end(ali3_instance *in, double h, const double *end) {
  const ali3_system *S = in->system;
  if (end != NULL && !ali3_finite(end, S->size.nu)) return ALI3_BAD_ARGUMENT;
  in->inputs.whole_time = ali3_time(in);
  in->inputs.whole_length = h;
  for (int32_t i = 0; i < S->size.nu; i++) {
    in->inputs.from[i] = in->inputs.set[i];
    in->inputs.to[i] = end != NULL ? fmax(S->input_min[i], fmin(S->input_max[i], end[i])) : in->inputs.set[i];
  }
  return ALI3_OK;
}

ali3_status ali3_inputs_begin(ali3_instance *in, double t, double h) {
  const ali3_system *S = in->system;
  in->inputs.part_time = in->clock.now;
  in->inputs.part_length = h;
  if (in->inputs.function != NULL) {
    const ali3_status status = call_function(in, in->clock.now, true, in->inputs.begin);
    return status == ALI3_OK ? call_function(in, t, false, in->inputs.set) : status;
  }
  const double remaining = in->inputs.whole_time + in->inputs.whole_length - t;
  memcpy(in->inputs.begin, in->clock.now == in->inputs.whole_time ? in->inputs.from : in->now.used,
         (size_t)S->size.nu * sizeof(double));
  memcpy(in->inputs.set, in->inputs.to, (size_t)S->size.nu * sizeof(double));
  /* large times have a coarse resolution */
  if (remaining > fmax(NEAR * in->inputs.whole_length, 4.0 * DBL_EPSILON * fabs(t)))
    for (int32_t i = 0; i < S->size.nu; i++)
      in->inputs.set[i] -= remaining / in->inputs.whole_length * (in->inputs.to[i] - in->inputs.from[i]);
  return ali3_roads_normals(in);
}

ali3_status ali3_inputs_at(ali3_instance *in, double fraction) {
  const double *u0 = in->inputs.begin;
  const size_t size = (size_t)in->system->size.nu * sizeof(double);
  if (in->inputs.function != NULL && fraction > 0.0 && fraction < 1.0)
    return call_function(in, in->inputs.part_time + fraction * in->inputs.part_length, false, in->inputs.middle);
  if (in->inputs.function != NULL)
    memcpy(in->inputs.middle, fraction > 0.0 ? in->inputs.set : u0, size);
  else
    for (int32_t i = 0; i < in->system->size.nu; i++)
      in->inputs.middle[i] = u0[i] + fraction * (in->inputs.set[i] - u0[i]);
  return ALI3_OK;
}

bool ali3_inputs_jump(const ali3_instance *in) {
  for (int32_t i = 0; i < in->system->size.nu; i++) {
    const double before = in->now.used[i], after = in->inputs.begin[i];
    if (fabs(after - before) > ROUND_OFF * (fabs(after) + fabs(before))) return true;
  }
  return false;
}

ali3_status ali3_set_input_function(ali3_instance *in, ali3_input_function *function, void *context) {
  if (in == NULL) return ALI3_BAD_ARGUMENT;
  in->inputs.function = function;
  in->inputs.context = context;
  in->inputs.n_breaks = 0;
  return ALI3_OK;
}

ali3_status ali3_set_input_breaks(ali3_instance *in, const double *time, int64_t n) {
  if (in == NULL || n < 0 || (n > 0 && time == NULL)) return ALI3_BAD_ARGUMENT;
  in->inputs.breaks = time;
  in->inputs.n_breaks = n;
  return ALI3_OK;
}

double ali3_inputs_until(const ali3_instance *in, double t) {
  int64_t low = 0, high = in->inputs.n_breaks;
  while (low < high) {
    const int64_t middle = low + (high - low) / 2;
    const bool past = in->inputs.breaks[middle] <= in->clock.now;
    low = past ? middle + 1 : low;
    high = past ? high : middle;
  }
  return low < in->inputs.n_breaks && in->inputs.breaks[low] < t ? in->inputs.breaks[low] : t;
}
