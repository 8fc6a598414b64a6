/* FMI 2.0 for a host that can give no functions, as the page that loads this as a WebAssembly module: callbacks whose
 * logger keeps the messages in memory, where the host reads them. Only with ALI3_ALONE. */
#include "fmi2_face.h"

#if defined(ALI3_ALONE)
#include <stdarg.h>
#include <string.h>

enum { MESSAGES = 1 << 16 };

/* The host reads it after each call and sets used and lost to 0. */
static struct {
  uint32_t used; /* bytes of text: a digit for the status, the category, a zero, the message, a zero; and the next */
  uint32_t lost; /* messages that found no room */
  char text[MESSAGES];
} box;

/* The shell gives the text as the format, with % and # doubled. */
static size_t undoubled(const char *text, char *to) {
  size_t n = 0;
  for (; *text != 0; text++) {
    if ((*text == '%' || *text == '#') && text[1] == *text) text++;
    to[n++] = *text;
  }
  to[n++] = 0;
  return n;
}

static void keep(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                 fmi2String message, ...) {
  (void)environment, (void)name;
  const size_t first = strlen(category) + 1, most = 1 + first + strlen(message) + 1;
  if (most > MESSAGES - box.used) {
    box.lost++;
    return;
  }
  char *to = box.text + box.used;
  *to++ = (char)('0' + status);
  memcpy(to, category, first);
  box.used += 1 + (uint32_t)(first + undoubled(message, to + first));
}

FMI2_EXPORT const fmi2CallbackFunctions *FMI2_NAME(ali3_callbacks)(void) {
  static const fmi2CallbackFunctions callbacks = {.logger = keep};
  return &callbacks;
}

FMI2_EXPORT void *FMI2_NAME(ali3_messages)(void) { return &box; }
#endif
