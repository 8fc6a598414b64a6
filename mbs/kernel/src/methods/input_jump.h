/* Accelerations after a jump of inputs. */
#ifndef ALI3_INPUT_JUMP_H
#define ALI3_INPUT_JUMP_H
#include "../instance.h"

/* Before a step h, s: if inputs have jumped, computes the accelerations and multipliers of in->now again, and corrects
 * the past ones that predict the next. Returns the status of their solution. */
ali3_status ali3_input_jump(ali3_instance *in, double h);
#endif
