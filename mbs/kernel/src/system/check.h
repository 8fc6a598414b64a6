/* Functions common to the checks of a System, which end at the first fault. */
#ifndef ALI3_CHECK_H
#define ALI3_CHECK_H
#include "../system.h"
#include "message.h"

#define CHECK(call)                                                                                                    \
  do {                                                                                                                 \
    const ali3_status status_ = (call);                                                                                \
    if (status_ != ALI3_OK) return status_;                                                                            \
  } while (0)

ali3_status ali3_check_length(ali3_message m, const char *name, int64_t n, int64_t expected);
ali3_status ali3_check_indices(ali3_message m, const char *name, const int32_t *v, int64_t n, int64_t low,
                               int64_t high);
int32_t ali3_find(const int32_t *sorted, int32_t n, int32_t value); /* position or -1 */
#endif
