/* The step compiled for groups of two lanes, for all processors. */
#define ALI3_WIDTH 2
#define ALI3_CODE ali3_code_lanes_2
#include "kernels.h"
