/* Time within a step at which a gap closes or opens, by a cubic through both ends. */
#include "crossing.h"

#include <math.h>
#include <stdbool.h>

enum { BISECTIONS = 40 };

typedef struct {
  double a, b, c, d; /* ((a s + b) s + c) s + d */
} cubic;

/* Value of the cubic at s. */
static double evaluate(const cubic *p, double s) { return ((p->a * s + p->b) * s + p->c) * s + p->d; }

/* Root of the cubic between `from` and `to`, where it is monotone and changes its sign. */
static double find_root(const cubic *p, double from, double to) {
  const bool above = evaluate(p, from) > 0.0;
  for (int i = 0; i < BISECTIONS; i++) {
    const double middle = 0.5 * (from + to);
    if ((evaluate(p, middle) > 0.0) == above)
      from = middle;
    else
      to = middle;
  }
  return to;
}

double ali3_crossing(double h, const double gap[2], const double rate[2]) {
  const double c = h * rate[0], end = h * rate[1], rise = gap[1] - gap[0];
  /* the tangents show that the gap stays open, or closed */
  if ((gap[0] > 0.0) == (gap[1] > 0.0) && (gap[0] > 0.0 ? c >= 0.0 || end <= 0.0 : c <= 0.0 || end >= 0.0)) return 1.0;
  const cubic p = {c + end - 2.0 * rise, 3.0 * rise - 2.0 * c - end, c, gap[0]};
  double stationary[4] = {ALI3_AT_END, 1.0, 1.0, 1.0 - ALI3_AT_END};
  const double square = p.b * p.b - 3.0 * p.a * p.c;
  if (square > 0.0) { /* stationary points, without cancellation */
    const double q = -(p.b + copysign(sqrt(square), p.b)), first = q / (3.0 * p.a), second = p.c / q;
    stationary[1] = fmin(first, second);
    stationary[2] = fmax(first, second);
  }
  for (int i = 1, from = 0; i < 4; i++) {
    if (!(stationary[i] > stationary[from] && stationary[i] <= stationary[3])) continue;
    if ((evaluate(&p, stationary[from]) > 0.0) != (evaluate(&p, stationary[i]) > 0.0))
      return find_root(&p, stationary[from], stationary[i]);
    from = i;
  }
  return 1.0;
}
