/* Parses decimal numbers identically on all platforms, independent of the locale. */
#include "parse_number.h"

#include <stdint.h>

static const uint64_t MAX_DIGITS = 100000000000000000u; /* below it, another digit still fits */
static const double MAX_VALUE = 1e300;
enum { MAX_EXPONENT = 1000 }; /* larger ones give 0 or are refused in any case */
enum { EXACT_POWERS = 22 }; /* 1e22 is the largest exact power of ten */

static int is_digit(const char *p, const char *end) { return p < end && *p >= '0' && *p <= '9'; }

/* Skips a sign; returns whether it is a minus. */
static int parse_sign(const char **p, const char *end) {
  const int negative = *p < end && **p == '-';
  if (negative || (*p < end && **p == '+')) ++*p;
  return negative;
}

/* Parses digits with at most one separator: value = digits 10^power. Returns 0 without a digit. */
static int parse_digits(const char **p, const char *end, int comma, uint64_t *digits, int *power) {
  int has_digits = 0, in_fraction = 0;
  *digits = 0;
  *power = 0;
  for (;; ++*p) {
    if (!is_digit(*p, end)) {
      if (in_fraction || *p >= end || !(**p == '.' || (comma && **p == ','))) return has_digits;
      in_fraction = 1;
      continue;
    }
    has_digits = 1;
    if (*digits < MAX_DIGITS) {
      *digits = 10 * *digits + (uint64_t)(**p - '0');
      *power -= in_fraction;
    } else {
      *power += !in_fraction;
    }
  }
}

/* Parses an exponent, if there is one, and adds it to *power. Returns 0 for an e without digits. */
static int parse_exponent(const char **p, const char *end, int *power) {
  int exponent = 0;
  if (*p >= end || !(**p == 'e' || **p == 'E')) return 1;
  ++*p;
  const int negative = parse_sign(p, end);
  if (!is_digit(*p, end)) return 0;
  for (; is_digit(*p, end); ++*p)
    if (exponent < MAX_EXPONENT) exponent = 10 * exponent + (**p - '0');
  *power += negative ? -exponent : exponent;
  return 1;
}

/* v 10^power, above MAX_VALUE any value above it */
static double scale_by_power(double v, int power) {
  for (; power > 0 && v > 0.0 && v < MAX_VALUE; power--) v *= 10.0;
  double divisor = 1.0;
  for (int k = 0; power < 0 && k < EXACT_POWERS; k++, power++) divisor *= 10.0;
  v /= divisor;
  for (; power < 0 && v > 0.0; power++) v /= 10.0;
  return v;
}

int ali3_parse_number(const char *p, const char *end, int comma, double *value) {
  uint64_t digits;
  int power;
  const int negative = parse_sign(&p, end);
  if (!parse_digits(&p, end, comma, &digits, &power) || !parse_exponent(&p, end, &power)) return 0;
  const double v = scale_by_power((double)digits, power);
  *value = negative ? -v : v;
  return p == end && v < MAX_VALUE;
}
