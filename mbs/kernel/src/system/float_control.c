/* Sets and restores the control of floating point. */
#include "../../include/ali3.h"

#if defined(__x86_64__)
#include <xmmintrin.h>

enum { FLAGS = 0x3f, USUAL = 0x1f80, THERE = 1 << 16 }; /* THERE: of a result, that it is not 0 */

ali3_float_control ali3_float_control_set(void) {
  const unsigned now = _mm_getcsr();
  if (ali3_float_control_is_usual()) return 0;
  _mm_setcsr((now & FLAGS) | USUAL);
  return (now & ~(unsigned)FLAGS) | THERE;
}

void ali3_float_control_restore(ali3_float_control before) {
  if (before != 0) _mm_setcsr((_mm_getcsr() & FLAGS) | ((unsigned)before & ~(unsigned)THERE));
}
#elif defined(__aarch64__)
ali3_float_control ali3_float_control_set(void) {
  ali3_float_control now;
  if (ali3_float_control_is_usual()) return 0;
  __asm__ volatile("mrs %0, fpcr" : "=r"(now)::"memory");
  __asm__ volatile("msr fpcr, %0" ::"r"((ali3_float_control)0) : "memory");
  return now;
}

void ali3_float_control_restore(ali3_float_control before) {
  if (before != 0) __asm__ volatile("msr fpcr, %0" ::"r"(before) : "memory");
}
#else
ali3_float_control ali3_float_control_set(void) { return 0; }

void ali3_float_control_restore(ali3_float_control before) { (void)before; }
#endif
