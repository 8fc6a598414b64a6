/* Normal forces of stops and contacts over the penetration x > 0: conservative force, loss, and exact means for steps
 * with discrete gradients.
 *
 * Conservative part: a progressive stage k x (1 + (x/L)^2) (rubber or foam that fills its housing; L = 0: linear) and a
 * hard end of stiffness K beyond x_end whose force begins as a parabola over w, so that the tangent is continuous.
 * Loss: Hunt and Crossley (Journal of Applied Mechanics 42, 1975, 440-445), force F (1 + chi x'), so that damping is
 * proportional to the force. For x' < 0 the factor is 1/(1 - chi x') with the same slope at 0, which is never negative:
 * there is no tension. A mass that hits it with v leaves with v1 for any F(x), where
 *   (chi v - ln(1 + chi v))/chi^2 = v1^2/2 + chi v1^3/3.
 * With a least restitution e > 0, chi x' saturates at 1/e - 1: the factor stays between e and 1/e, and v1/v of fast
 * impacts approaches e. */
#ifndef ALI3_CONTACT_LAW_H
#define ALI3_CONTACT_LAW_H
#include "element.h"

typedef struct {
  real stiffness, progression; /* k, L */
  real end, hard_stiffness, onset; /* x_end, K, w > 0 where K > 0 */
  real loss, restitution; /* chi, s/m; e, 0: chi x' does not saturate */
} ali3_contact_law;

/* Conservative force; adds to *slope and *energy. 0 for x <= 0. */
ALI3_PER_WIDTH real ali3_contact_force(const ali3_contact_law *law, real x, real *slope, real *energy);

/* Mean of the conservative force over x from x0 to x1: the difference quotient of its energy, free of cancellation. */
double ali3_contact_mean(const ali3_contact_law *law, double x0, double x1);

/* Factor of the force at the rate x', and d(factor)/d(rate). */
ALI3_PER_WIDTH real ali3_contact_loss(const ali3_contact_law *law, real rate, real *slope);
#endif
