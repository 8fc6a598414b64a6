/* Accelerations after a jump of inputs. */
#ifndef ALI3_INPUT_JUMP_H
#define ALI3_INPUT_JUMP_H
#include "../instance.h"

ali3_status ali3_input_jump(ali3_instance *in, double h);
#endif
