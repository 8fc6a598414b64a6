/* Sets and restores the floating-point control register: default rounding, no flushing of denormals. */
#include "../../include/ali3.h"

#if defined(__x86_64__)
#include <xmmintrin.h>

enum { FLAGS = 0x3f, USUAL = 0x1f80, THERE = 1 << 16 }; /* THERE: marks a saved value, so that it is not 0 */

ali3_float_control ali3_float_control_set(void) {
  const unsigned now = _mm_getcsr();
  if (ali3_float_control_is_usual()) return 0;
  _mm_setcsr((now & FLAGS) | USUAL);
  return (now & ~(unsigned)FLAGS) | THERE;
}

void ali3_float_control_restore(ali3_float_control previous) {
  if (previous != 0) _mm_setcsr((_mm_getcsr() & FLAGS) | ((unsigned)previous & ~(unsigned)THERE));
}
#elif defined(__aarch64__)
ali3_float_control ali3_float_control_set(void) {
  ali3_float_control now;
  if (ali3_float_control_is_usual()) return 0;
  __asm__ volatile("mrs %0, fpcr" : "=r"(now)::"memory");
  __asm__ volatile("msr fpcr, %0" ::"r"((ali3_float_control)0) : "memory");
  return now;
}

void ali3_float_control_restore(ali3_float_control previous) {
  if (previous != 0) __asm__ volatile("msr fpcr, %0" ::"r"(previous) : "memory");
}
#else
ali3_float_control ali3_float_control_set(void) { return 0; }

void ali3_float_control_restore(ali3_float_control previous) { (void)previous; }
#endif
