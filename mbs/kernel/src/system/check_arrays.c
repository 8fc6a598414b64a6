/* Checks the lengths and values of all arrays of a System against their list, ALI3_SYSTEM_ARRAYS. */
#include "../lookup/lookup.h"
#include "../rows/assembly_mode.h"
#include "../rows/driving_functions.h"
#include "../system.h"
#include "check.h"
#include "loading.h"
#include "message.h"
#include "sensor_types.h"

_Static_assert(ALI3_INERTIA_REALS == 10 && ALI3_INERTIA_SIGNALS == 12, "as the list has them");
_Static_assert(ALI3_AXIS_REALS == 2 && ALI3_AXIS_SIGNALS == 9, "as the list has them");
_Static_assert(ALI3_LOOKUP_MOMENTS == 10 && ALI3_TRIAD_ITEMS == 11, "as the list has them");

typedef enum { IN_RANGE, OFFSETS_TO, OFFSETS_ALONE, NUMBERS, NUMBERS_OR_INFINITE, UNCHECKED } values_rule;

typedef struct {
  const char *name;
  const void *items;
  int64_t n, length;
  values_rule rule;
  int64_t low, high; /* ends of the range, `high` excluded; of OFFSETS_TO the last offset in `high` */
} limits_of_array;

/* Offsets begin with 0, do not decrease, and end with the length of the array that they divide. */
static ali3_status check_offsets(ali3_message m, const limits_of_array *a) {
  const int32_t *v = a->items;
  if (a->n == 0 && a->high == 0) return ALI3_OK;
  if (a->n == 0) return ali3_bad(m, "'%s' has no items and is to end at %lld", a->name, (long long)a->high);
  const int64_t last = a->rule == OFFSETS_ALONE ? v[a->n - 1] : a->high;
  if (v[0] != 0 || v[a->n - 1] != last)
    return ali3_bad(m, "'%s' runs from %d to %d instead of 0 to %lld", a->name, (int)v[0], (int)v[a->n - 1],
                    (long long)last);
  for (int64_t i = 0; i + 1 < a->n; i++)
    if (v[i] > v[i + 1]) return ali3_bad(m, "'%s' decreases at item %lld", a->name, (long long)i);
  return ALI3_OK;
}

/* Numbers are finite, or infinite if the list allows it, but not NaN. */
static ali3_status check_numbers(ali3_message m, const limits_of_array *a) {
  const double *v = a->items;
  for (int64_t i = 0; i < a->n; i++)
    if (a->rule == NUMBERS ? !(v[i] - v[i] == 0.0) : v[i] != v[i])
      return ali3_bad(m, "item %lld of '%s' is not a finite number", (long long)i, a->name);
  return ALI3_OK;
}

/* Items of an array by its rule. */
static ali3_status check_values(ali3_message m, const limits_of_array *a) {
  switch (a->rule) {
  case IN_RANGE:
    return ali3_check_indices(m, a->name, a->items, a->n, a->low, a->high);
  case OFFSETS_TO:
  case OFFSETS_ALONE:
    return check_offsets(m, a);
  case NUMBERS:
  case NUMBERS_OR_INFINITE:
    return check_numbers(m, a);
  default:
    return ALI3_OK;
  }
}

/* clang-format off */
/* Definitions of the words in the list; `n`: length of the checked array. */
#define ANY n
#define RELATED_LENGTH n
#define OR_NONE(size) (n == 0 ? 0 : (size))
#define IF_ANY(count, size) ((count) == 0 ? 0 : (size))
#define ANY_IF(count) ((count) == 0 ? 0 : n)
#define BELOW(size) IN_RANGE, 0, size
#define WITHIN(least, most) IN_RANGE, least, (most) + 1
#define OFFSETS(array) OFFSETS_TO, 0, s->n_##array
#define ASCENDING OFFSETS_ALONE, 0, 1
#define RELATED UNCHECKED, 0, 0
#define TEXT UNCHECKED, 0, 0
#define FINITE NUMBERS, 0, 0
#define OR_INFINITE NUMBERS_OR_INFINITE, 0, 0
/* clang-format on */

/* Checks all lengths before all values, so that a message names an array that is too short, not one whose offsets end
 * beyond it. */
ali3_status ali3_check_arrays(const ali3_system *s, ali3_message m) {
#define ALI3_SIZE(name, array, each, words) const int64_t name = s->n_##array / each;
  ALI3_SYSTEM_SIZES(ALI3_SIZE)
#undef ALI3_SIZE
  limits_of_array arrays[ALI3_ARRAY_COUNT], *end = arrays;
#define ALI3_LIMITS(items, array, presence, size, values, words)                                                       \
  {                                                                                                                    \
    const int64_t n = s->n_##array;                                                                                    \
    *end++ = (limits_of_array){#array, s->array, n, size, values};                                                     \
  }
  ALI3_SYSTEM_ARRAYS(ALI3_LIMITS)
#undef ALI3_LIMITS
  for (const limits_of_array *a = arrays; a < end; a++) CHECK(ali3_check_length(m, a->name, a->n, a->length));
  for (const limits_of_array *a = arrays; a < end; a++) CHECK(check_values(m, a));
  return ALI3_OK;
}
