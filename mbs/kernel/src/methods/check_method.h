/* Which method takes which System. */
#ifndef ALI3_CHECK_METHOD_H
#define ALI3_CHECK_METHOD_H
#include "../instance.h"

ali3_status ali3_check_method(ali3_instance *in);
bool ali3_relative(const ali3_instance *in);
#endif
