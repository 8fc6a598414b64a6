/* Conditions that Systems must fulfil for a method. */
#include "check_method.h"
#include "../elements/element.h"
#include "../instance.h"
#include "../system/state_coordinates.h"

/* Whether element e has a potential and no loss with its present numbers. */
static bool is_conservative(const ali3_instance *in, int32_t e) {
  const ali3_element_type *type = in->system->el_kind[e];
  const int32_t first = in->system->el_parameter_ptr[e], n = in->system->el_parameter_ptr[e + 1] - first;
  return type->conservative && !(type->lossy != NULL && type->lossy(in->parameters.el_parameter + first, n,
                                                                    in->system->el_int + in->system->el_int_ptr[e]));
}

bool ali3_conservative(const ali3_instance *in) {
  const ali3_system *S = in->system;
  for (int64_t i = 0; i < S->n_flex_C; i++)
    if (S->flex_C[i] != 0.0) return false;
  for (int32_t e = 0; e < S->size.ne; e++)
    if (!is_conservative(in, e)) return false;
  return true;
}

ali3_status ali3_needs_no_states(const ali3_instance *in) {
  return ali3_states_are_coordinates(in->system) ? ALI3_OK : ALI3_WRONG_METHOD;
}
