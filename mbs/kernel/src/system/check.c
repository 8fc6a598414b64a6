/* Functions common to the checks of a System. */
#include "check.h"

#include <stdlib.h>

#include "message.h"

ali3_status ali3_check_indices(ali3_message m, const char *name, const int32_t *v, int64_t n, int64_t low,
                               int64_t high) {
  for (int64_t i = 0; i < n; i++)
    if (v[i] < low || v[i] >= high)
      return ali3_bad(m, "item %lld of '%s' is %d, outside %lld..%lld", (long long)i, name, (int)v[i], (long long)low,
                      (long long)high - 1);
  return ALI3_OK;
}

/* For qsort. */
static int compare_int32(const void *a, const void *b) {
  const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
  return (x > y) - (x < y);
}

void ali3_sort(int32_t *v, int32_t n) { qsort(v, (size_t)n, sizeof *v, compare_int32); }

int32_t ali3_find(const int32_t *sorted, int32_t n, int32_t value) {
  int32_t low = 0, high = n;
  while (low < high) {
    const int32_t middle = low + (high - low) / 2;
    if (sorted[middle] < value)
      low = middle + 1;
    else
      high = middle;
  }
  return low < n && sorted[low] == value ? low : -1;
}

ali3_status ali3_check_length(ali3_message m, const char *name, int64_t n, int64_t expected) {
  if (n == expected) return ALI3_OK;
  return ali3_bad(m, "'%s' has %lld items instead of %lld", name, (long long)n, (long long)expected);
}
