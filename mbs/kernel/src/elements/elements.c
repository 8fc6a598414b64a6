/* The table of element types. */
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
