/* Forces of a step by discrete gradients. */
#ifndef ALI3_DISCRETE_GRADIENT_H
#define ALI3_DISCRETE_GRADIENT_H
#include "element.h"

ali3_element_function *ali3_discrete_gradient(int32_t type); /* NULL: the middle of the step is exact or as good */
#endif
