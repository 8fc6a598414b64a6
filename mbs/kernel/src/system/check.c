/* What all checks of a System share. */
#include "check.h"

#include "message.h"

ali3_status ali3_check_indices(ali3_message m, const char *name, const int32_t *v, int64_t n, int64_t low,
                               int64_t high) {
  for (int64_t i = 0; i < n; i++)
    if (v[i] < low || v[i] >= high)
      return ali3_bad(m, "item %lld of '%s' is %d, outside %lld..%lld", (long long)i, name, (int)v[i], (long long)low,
                      (long long)high - 1);
  return ALI3_OK;
}

ali3_status ali3_check_pointers(ali3_message m, const char *name, const int32_t *ptr, int64_t n_ptr, int64_t n,
                                int64_t total) {
  if (n_ptr != n + 1)
    return ali3_bad(m, "'%s' has %lld items instead of %lld", name, (long long)n_ptr, (long long)n + 1);
  if (ptr[0] != 0 || ptr[n] != total)
    return ali3_bad(m, "'%s' runs from %d to %d instead of 0 to %lld", name, (int)ptr[0], (int)ptr[n],
                    (long long)total);
  for (int64_t i = 0; i < n; i++)
    if (ptr[i] > ptr[i + 1]) return ali3_bad(m, "'%s' decreases at item %lld", name, (long long)i);
  return ALI3_OK;
}

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
