/* Checks the sensors of a System file against the list of their types; sensor_types.h explains the letters. */
#include <string.h>

#include "../rows/driving_functions.h"
#include "../system.h"
#include "check.h"
#include "loading.h"
#include "message.h"
#include "sensor_types.h"

const ali3_sensor_type ali3_sensor_types[ALI3_SENSOR_TYPE_COUNT] = {
#define ALI3_SENSOR_TYPE(number, NAME, name, letters, n_real, n_real_each, of_rate, of_reads, ...)                     \
  [number] = {.integers = letters,                                                                                     \
              .reals = n_real,                                                                                         \
              .reals_each = n_real_each,                                                                               \
              .rate = ALI3_RATE_##of_rate,                                                                             \
              .reads = ALI3_READS_##of_reads},
    ALI3_SENSOR_TYPES(ALI3_SENSOR_TYPE)
#undef ALI3_SENSOR_TYPE
};

/* Least value of an integer with this letter. */
static int64_t least(char letter) {
  if (letter == 'S' || letter == 'G' || letter == 'T') return -1;
  return letter == 'N' ? 1 : (letter == 'P' ? 2 : 0);
}

/* Upper limit, excluded, of the integer at v. */
static int64_t limit(const ali3_system *s, char letter, const int32_t *v) {
  switch (letter) {
  case 's':
  case 'S':
    return s->size.nsig;
  case 'g':
  case 'G':
  case 'T':
    return s->size.ng;
  case 'e':
    return s->size.ne;
  case 'o':
    return s->el_out_ptr[v[-1] + 1] - s->el_out_ptr[v[-1]];
  case 'u':
    return s->size.nu;
  case 'r':
    return s->size.nc;
  case 'b':
    return 2;
  case 'd':
    return 3;
  case 'k':
  case 'q':
  case 'P':
    return 4;
  case 'h':
    return ALI3_SOLVER_COUNT;
  default: /* n, N */
    return INT32_MAX;
  }
}

/* Counts of integers and reals, and the range of each integer: first those before the brackets, then of each item. */
static ali3_status check_sensor(const ali3_system *s, int32_t i, ali3_message m) {
  const ali3_sensor_type *type = &ali3_sensor_types[s->sen_type[i]];
  const int32_t *v = s->sen_int + s->sen_int_ptr[i];
  const int32_t n = s->sen_int_ptr[i + 1] - s->sen_int_ptr[i],
                n_real = s->sen_parameter_ptr[i + 1] - s->sen_parameter_ptr[i];
  const int32_t head = (int32_t)strcspn(type->integers, "("), all = (int32_t)strlen(type->integers);
  const int32_t each = all > head ? all - head - 2 : 0; /* letters in the brackets */
  int64_t items = 0;
  for (int32_t k = 0; k < n && (k < head || k < head + items * each); k++) {
    const char letter = type->integers[k < head ? k : head + 1 + (k - head) % each];
    CHECK(ali3_check_indices(m, "sen_int", v + k, 1, least(letter), limit(s, letter, v + k)));
    if (letter == 'T' && v[k] >= 0 && s->guide_type[v[k]] != ALI3_DRIVING_BY_TABLE)
      return ali3_bad(m, "sensor %d reads the slope of driving function %d, which is by no table", (int)i, (int)v[k]);
    if (k < head && strchr("nNP", letter) != NULL) items = v[k];
  }
  if (n < head || n != head + items * each)
    return ali3_bad(m, "sensor %d of type %d has %d integers", (int)i, (int)s->sen_type[i], (int)n);
  if (n_real != type->reals + items * type->reals_each)
    return ali3_bad(m, "sensor %d of type %d has %d reals", (int)i, (int)s->sen_type[i], (int)n_real);
  return ALI3_OK;
}

ali3_status ali3_check_sensors(const ali3_system *s, ali3_message m) {
  for (int32_t i = 0; i < s->size.ns; i++) CHECK(check_sensor(s, i, m));
  return ALI3_OK;
}
