/* The longest vectors for which the processor has instructions. */
#include "processor.h"

#if defined(__x86_64__)
#include <cpuid.h>

enum { SAVES_STATE = 1 << 27, AVX2 = 1 << 5, AVX512F = 1 << 16, AVX512DQ = 1 << 17 }; /* of cpuid 1 and 7 */
static const unsigned AVX512VL = 1u << 31;
enum { YMM_SAVED = 0x06, ZMM_SAVED = 0xe6 }; /* by the operating system */

int32_t ali3_processor_lanes(void) {
  unsigned a, b, c, d, low, high;
  if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & SAVES_STATE)) return 2;
  __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  if (!__get_cpuid_count(7, 0, &a, &b, &c, &d) || (low & YMM_SAVED) != YMM_SAVED || !(b & AVX2)) return 2;
  return (low & ZMM_SAVED) == ZMM_SAVED && (b & AVX512F) && (b & AVX512DQ) && (b & AVX512VL) ? 8 : 4;
}
#else
int32_t ali3_processor_lanes(void) { return 2; }
#endif
