/* Instruction sets of the processor, detected at run time, and functions compiled for more than one of them. */
#ifndef ALI3_PROCESSOR_H
#define ALI3_PROCESSOR_H
#include <stdint.h>

#include "real.h"

int32_t ali3_processor_lanes(void); /* numbers in the longest vectors of the processor: 2, 4 or 8 */

#define ALI3_INLINED static inline __attribute__((always_inline)) /* compiled with the target of its caller */

/* Defines ali3_NAME by the ALI3_INLINED function NAME, compiled for all processors and for those with AVX2. No
 * arithmetic is fused or reordered, so that both have the same bits. Lanes are compiled for their processor already. */
#if defined(__x86_64__) && !defined(ALI3_WIDTH)
#define ALI3_BY_PROCESSOR(system, type, name, declared, given)                                                         \
  __attribute__((target("avx2"))) static type name##_avx2 declared { return name given; }                              \
  type ali3_##name declared { return (system)->has_avx2 ? name##_avx2 given : name given; }
#else
#define ALI3_BY_PROCESSOR(system, type, name, declared, given)                                                         \
  ALI3_PER_WIDTH type ali3_##name declared { return name given; }
#endif
#endif
