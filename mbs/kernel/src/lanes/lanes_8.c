/* The step compiled for groups of eight lanes with AVX-512. */
#if defined(__x86_64__)
#define ALI3_WIDTH 8
#define ALI3_CODE ali3_code_lanes_8
#define ALI3_INSTRUCTIONS "avx512f,avx512dq,avx512vl"
#if !defined(__clang__)
#pragma GCC target("avx512f,avx512dq,avx512vl")
#endif
#include "kernels.h"
#else
#include "group.h" /* on other processors no group has eight lanes */
#endif
