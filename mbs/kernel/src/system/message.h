/* Message of a refused System file. */
#ifndef ALI3_MESSAGE_H
#define ALI3_MESSAGE_H
#include <stddef.h>

#include "../../include/ali3.h"

typedef struct {
  char *text;
  size_t size;
} ali3_message;
ali3_status ali3_bad(ali3_message m, const char *format, ...);
#endif
