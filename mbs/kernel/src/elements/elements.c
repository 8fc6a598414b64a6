/* The table of element types, and what their numbers must be. */
#include <stddef.h>

#include "element.h"

const ali3_element_type *ali3_element_type_get(int32_t type) {
  switch (type) {
#define ALI3_ENTRY(number, name)                                                                                       \
  case number:                                                                                                         \
    return &ali3_##name;
    ALI3_ELEMENT_TYPES(ALI3_ENTRY)
#undef ALI3_ENTRY
  default:
    return NULL;
  }
}

static bool lies_in(ali3_range range, double x) {
  switch (range) {
  case ALI3_IS_NOT_NEGATIVE:
    return x >= 0.0;
  case ALI3_IS_POSITIVE:
    return x > 0.0;
  case ALI3_IS_SHARE:
    return x > 0.0 && x <= 1.0;
  case ALI3_IS_FRACTION:
    return x >= 0.0 && x < 1.0;
  default:
    return true;
  }
}

const char *ali3_element_check(const ali3_element_type *type, int32_t nsig, const double *real, int32_t nreal,
                               const int32_t *integer, int32_t nint, int32_t n_inputs, int32_t n_roads) {
  for (int32_t i = 0; i < type->nfields && i < nreal; i++)
    if (!lies_in(type->fields[i].range, real[i])) return type->fields[i].text;
  return type->check == NULL ? NULL : type->check(nsig, real, nreal, integer, nint, n_inputs, n_roads);
}
