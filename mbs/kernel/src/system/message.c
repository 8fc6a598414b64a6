/* Message of a refused System file. */
#include "message.h"

#include <stdarg.h>
#include <stdio.h>

ali3_status ali3_bad(ali3_message m, const char *format, ...) {
  if (m.text != NULL && m.size > 0) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(m.text, m.size, format, arguments);
    va_end(arguments);
  }
  return ALI3_BAD_FILE;
}
