/* Parameters of an instance: what they write to its copies of the data of elements, guides and roads. */
#include <string.h>

#include "../instance.h"
#include "../system/loading.h"
#include "parameters.h"

/* What a parameter of a value writes to its target k. */
double ali3_parameter_writes(const ali3_system *S, int64_t k, double value) {
  const double product = S->par_scale[k] * value;
  return S->n_par_offset > 0 ? product + S->par_offset[k] : product;
}

static void write(ali3_instance *in, int32_t p) {
  const ali3_system *S = in->system;
  double *target[ALI3_TARGET_COUNT] = {
      [ALI3_TARGET_ELEMENT] = in->el_real, [ALI3_TARGET_GUIDE] = in->guide_real, [ALI3_TARGET_ROAD] = in->road_real};
  for (int32_t k = S->par_ptr[p]; k < S->par_ptr[p + 1]; k++)
    target[S->par_target[k]][S->par_index[k]] = ali3_parameter_writes(S, k, in->parameter[p]);
}

/* All of them; refused as a whole when an element, guide or road cannot take its data. */
ali3_status ali3_parameters_apply(ali3_instance *in) {
  const ali3_system *S = in->system;
  for (int32_t p = 0; p < S->size.np; p++) write(in, p);
  return ali3_check_data(S, in->el_real, in->guide_real, in->road_real) == NULL ? ALI3_OK : ALI3_BAD_ARGUMENT;
}

/* One of them, and the checks of what it writes to. */
static ali3_status take(ali3_instance *in, int32_t p, double value) {
  const ali3_system *S = in->system;
  in->parameter[p] = value;
  write(in, p);
  for (int32_t k = S->par_ptr[p]; k < S->par_ptr[p + 1]; k++)
    if (ali3_check_target(S, k, in->el_real, in->guide_real, in->road_real) != NULL) return ALI3_BAD_ARGUMENT;
  return ALI3_OK;
}

static bool in_range(const ali3_instance *in, int32_t index, double value) {
  return in != NULL && index >= 0 && index < in->system->size.np && value - value == 0.0 &&
         value >= in->system->par_min[index] && value <= in->system->par_max[index];
}

ali3_status ali3_set_parameter(ali3_instance *in, int32_t index, double value) {
  if (!in_range(in, index, value)) return ALI3_BAD_ARGUMENT;
  const double before = in->parameter[index];
  if (in->initialised && in->system->n_par_fixed > 0 && in->system->par_fixed[index]) return ALI3_FIXED_PARAMETER;
  const ali3_status status = take(in, index, value);
  if (status != ALI3_OK) take(in, index, before);
  return status;
}

ali3_status ali3_try_parameter(ali3_instance *in, int32_t index, double value) {
  if (!in_range(in, index, value)) return ALI3_BAD_ARGUMENT;
  const double before = in->parameter[index];
  const ali3_status status = take(in, index, value);
  take(in, index, before);
  return status;
}

ali3_status ali3_get_parameter(const ali3_instance *in, int32_t index, double *value) {
  if (in == NULL || value == NULL || index < 0 || index >= in->system->size.np) return ALI3_BAD_ARGUMENT;
  *value = in->parameter[index];
  return ALI3_OK;
}
