/* Functions common to the checks of a System, which end at the first fault. */
#ifndef ALI3_CHECK_H
#define ALI3_CHECK_H
#include "../system.h"
#include "message.h"

/* Returns the status of a call from the calling function, unless it is ALI3_OK. */
#define CHECK(call)                                                                                                    \
  do {                                                                                                                 \
    const ali3_status status_ = (call);                                                                                \
    if (status_ != ALI3_OK) return status_;                                                                            \
  } while (0)

/* Refuses an array `name` of n items instead of `expected` ones. */
ali3_status ali3_check_length(ali3_message m, const char *name, int64_t n, int64_t expected);
/* Refuses an array `name` with an item v[i] outside low <= v[i] < high. */
ali3_status ali3_check_indices(ali3_message m, const char *name, const int32_t *v, int64_t n, int64_t low,
                               int64_t high);
/* Sorts n numbers in ascending order. */
void ali3_sort(int32_t *v, int32_t n);
/* Position of a value in n ascending ones, or -1. */
int32_t ali3_find(const int32_t *sorted, int32_t n, int32_t value);
#endif
