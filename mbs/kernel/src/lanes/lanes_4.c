/* The step compiled for groups of four lanes with AVX2. */
#if defined(__x86_64__)
#define ALI3_WIDTH 4
#define ALI3_CODE ali3_code_lanes_4
#define ALI3_INSTRUCTIONS "avx2"
#if !defined(__clang__)
#pragma GCC target("avx2")
#endif
#include "kernels.h"
#else
#include "group.h" /* on other processors no group has four lanes */
#endif
