/* Parses decimal numbers identically on all platforms, independent of the locale. */
#ifndef ALI3_PARSE_NUMBER_H
#define ALI3_PARSE_NUMBER_H

/* Parses the text from p to end as one number; 0 if it is not one. `comma`: the decimal separator may be a comma, too.
 * Error at most 1.5 units in the last place; exact to 15 digits. */
int ali3_parse_number(const char *p, const char *end, int comma, double *value);
#endif
