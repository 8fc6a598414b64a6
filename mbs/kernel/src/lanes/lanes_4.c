/* Four lanes. */
#if defined(__x86_64__)
#define ALI3_WIDTH 4
#define ALI3_CODE ali3_code_lanes_4
#define ALI3_INSTRUCTIONS "avx2"
#if !defined(__clang__)
#pragma GCC target("avx2")
#endif
#include "kernels.h"
#else
#include "group.h" /* no processor of another kind is asked for them */
#endif
