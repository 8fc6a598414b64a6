/* Two lanes, which every processor has. */
#define ALI3_WIDTH 2
#define ALI3_CODE ali3_code_lanes_2
#include "kernels.h"
