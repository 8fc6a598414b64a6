/* The table of element types, and checks of their data. */
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

static bool is_in_range(ali3_range range, double x) {
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

bool ali3_element_fits(const ali3_element_type *type, int32_t nsig, int32_t nreal, const int32_t *integer, int32_t nint,
                       int32_t nstate, int32_t nout) {
  if (type->nsig != -1 && nsig != type->nsig && (type->nsig_plane == 0 || nsig != type->nsig_plane)) return false;
  if (nint < type->nint || nint > type->nintegers) return false;
  int64_t reals = type->nreal, states = type->nstate;
  for (int32_t i = 0; i < nint; i++) {
    const int64_t count = integer[i] > 0 ? integer[i] : 0;
    reals += type->integers[i].reals * count, states += type->integers[i].states * count;
  }
  const bool extended = nint > type->nint, has_optional_reals = type->nint == type->nintegers;
  if (extended) states += type->nstate_more;
  const bool reals_fit = type->nreal == -1 || nreal == reals + (extended ? type->nreal_more : 0) ||
                         (has_optional_reals && nreal == reals + type->nreal_more);
  return reals_fit && nstate == states && nout == type->nout;
}

/* NULL, or the sentence of the first integer outside its range. */
static const char *check_integers(const ali3_element_type *type, const int32_t *integer, int32_t nint, int32_t n_inputs,
                                  int32_t n_roads) {
  for (int32_t i = 0; i < nint && i < type->nintegers; i++) {
    const ali3_integer *kind = &type->integers[i];
    const int32_t limit = kind->of == ALI3_OF_INPUTS  ? n_inputs - 1
                          : kind->of == ALI3_OF_ROADS ? n_roads - 1
                                                      : kind->most;
    if (integer[i] < kind->least || integer[i] > limit) return kind->text;
  }
  return NULL;
}

/* The last nreal_more fields belong to the last reals, if present. */
static const char *check_fields(const ali3_element_type *type, const double *real, int32_t nreal, bool has_more) {
  const int32_t first = type->nfields - type->nreal_more;
  for (int32_t i = 0; i < (has_more ? type->nfields : first); i++) {
    const int32_t index = i < first ? i : nreal - type->nfields + i;
    if (!is_in_range(type->fields[i].range, real[index])) return type->fields[i].text;
  }
  return NULL;
}

const char *ali3_element_check(const ali3_element_type *type, int32_t nsig, const double *real, int32_t nreal,
                               const int32_t *integer, int32_t nint, int32_t n_inputs, int32_t n_roads) {
  const char *text = check_integers(type, integer, nint, n_inputs, n_roads);
  const bool has_more = nint > type->nint || (type->nint == type->nintegers && nreal > type->nreal);
  if (text == NULL) text = check_fields(type, real, nreal, has_more);
  if (text != NULL || type->check == NULL) return text;
  return type->check(nsig, real, nreal, integer, nint);
}
