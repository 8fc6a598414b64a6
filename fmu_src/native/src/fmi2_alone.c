/* FMI 2.0 for a host without callback functions, such as a page that loads this as a WebAssembly module: a logger that
 * stores messages in memory for the host. Only with ALI3_ALONE. */
#include "fmi2_adapter.h"

#if defined(ALI3_ALONE)
#include <stdarg.h>
#include <string.h>

enum { CAPACITY = 1 << 16 };

/* The host reads the messages after each call and sets used and lost to 0. */
static struct {
  uint32_t used; /* bytes of text; per message: a digit for the status, the category, a zero, the text, a zero */
  uint32_t lost; /* messages for which there was no space */
  char text[CAPACITY];
} messages;

/* Copies the text of a format string in which % and # are doubled. Returns its size with the final zero. */
static size_t copy_undoubled(const char *text, char *to) {
  size_t n = 0;
  for (; *text != 0; text++) {
    if ((*text == '%' || *text == '#') && text[1] == *text) text++;
    to[n++] = *text;
  }
  to[n++] = 0;
  return n;
}

/* Logger: stores the last message for the page. */
static void store_message(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                          fmi2String message, ...) {
  (void)environment, (void)name;
  const size_t category_size = strlen(category) + 1, size = 1 + category_size + strlen(message) + 1;
  if (size > CAPACITY - messages.used) {
    messages.lost++;
    return;
  }
  char *to = messages.text + messages.used;
  *to++ = (char)('0' + status);
  memcpy(to, category, category_size);
  messages.used += 1 + (uint32_t)(category_size + copy_undoubled(message, to + category_size));
}

FMI2_EXPORT const fmi2CallbackFunctions *FMI2_NAME(ali3_callbacks)(void) {
  static const fmi2CallbackFunctions callbacks = {.logger = store_message};
  return &callbacks;
}

FMI2_EXPORT void *FMI2_NAME(ali3_messages)(void) { return &messages; }
#endif
