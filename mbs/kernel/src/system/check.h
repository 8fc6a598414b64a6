/* What all checks of a System share: the first thing found wrong ends them. */
#ifndef ALI3_CHECK_H
#define ALI3_CHECK_H
#include "../ali3_internal.h"

#define CHECK(call)                                                                                                    \
  do {                                                                                                                 \
    const ali3_status status_ = (call);                                                                                \
    if (status_ != ALI3_OK) return status_;                                                                            \
  } while (0)

ali3_status ali3_check_length(ali3_message m, const char *name, int64_t n, int64_t expected);

#endif
