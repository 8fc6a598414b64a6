/* Two lanes, which every processor has. */
#define ALI3_WIDTH 2
#include "kernels.h"
