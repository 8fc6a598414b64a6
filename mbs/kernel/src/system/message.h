/* Message of a refused System file. */
#ifndef ALI3_MESSAGE_H
#define ALI3_MESSAGE_H
#include <stddef.h>

#include "../../include/ali3.h"

typedef struct {
  char *text; /* NULL: no message */
  size_t size; /* bytes, including the terminator */
} ali3_message;
/* Writes a formatted message, cut to its size, and returns ALI3_BAD_FILE. */
ali3_status ali3_bad(ali3_message m, const char *format, ...);
#endif
