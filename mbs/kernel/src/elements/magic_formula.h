/* Magic Formula tyre characteristics, steady: PAC2002 and MF-Tyre 5.2 (H. B. Pacejka, Tire and Vehicle Dynamics, 2nd
 * ed., 2006, section 4.3.2), MF-Tyre 6.1 and 6.2 (the same, 3rd ed., 2012, section 4.3.2, with the equations 4.E...; I.
 * J. M. Besselink, A. J. C. Schmeitz, H. B. Pacejka, Vehicle System Dynamics 48(S1), 2010, 337-352). No turn slip. */
#ifndef ALI3_MAGIC_FORMULA_H
#define ALI3_MAGIC_FORMULA_H
#include <stdint.h>

/* Name of a coefficient in a .tir file and its default value, in the order of the element's numbers. */
/* clang-format off */
#define ALI3_MAGIC_COEFFICIENTS(X) \
  X(LFZO, 1) X(LCX, 1) X(LMUX, 1) X(LEX, 1) X(LKX, 1) X(LHX, 1) X(LVX, 1) X(LGAX, 1) X(LCY, 1) X(LMUY, 1) X(LEY, 1) \
  X(LKY, 1) X(LHY, 1) X(LVY, 1) X(LGAY, 1) X(LKYC, 1) X(LKZC, 1) X(LTR, 1) X(LRES, 1) X(LGAZ, 1) X(LXAL, 1) X(LYKA, 1) \
  X(LVYKA, 1) X(LS, 1) X(LSGKP, 1) X(LSGAL, 1) X(LMX, 1) X(LVMX, 1) X(LMY, 1) X(LMUV, 0) \
  X(LONGVL, 16.7) X(NOMPRES, 0) X(Q_RE0, 1) X(Q_V1, 0) X(Q_V2, 0) X(PFZ1, 0) X(BREFF, 0) X(DREFF, 0) X(FREFF, 0) \
  X(LONGITUDINAL_STIFFNESS, 0) X(LATERAL_STIFFNESS, 0) X(PCFX1, 0) X(PCFX2, 0) X(PCFX3, 0) X(PCFY1, 0) X(PCFY2, 0) \
  X(PCFY3, 0) X(PTX1, 0) X(PTX2, 0) X(PTX3, 0) X(PTY1, 0) X(PTY2, 1) \
  X(PCX1, 0) X(PDX1, 0) X(PDX2, 0) X(PDX3, 0) X(PEX1, 0) X(PEX2, 0) X(PEX3, 0) X(PEX4, 0) X(PKX1, 0) X(PKX2, 0) \
  X(PKX3, 0) X(PHX1, 0) X(PHX2, 0) X(PVX1, 0) X(PVX2, 0) X(PPX1, 0) X(PPX2, 0) X(PPX3, 0) X(PPX4, 0) \
  X(RBX1, 0) X(RBX2, 0) X(RBX3, 0) X(RCX1, 0) X(REX1, 0) X(REX2, 0) X(RHX1, 0) \
  X(PCY1, 0) X(PDY1, 0) X(PDY2, 0) X(PDY3, 0) X(PEY1, 0) X(PEY2, 0) X(PEY3, 0) X(PEY4, 0) X(PEY5, 0) X(PKY1, 0) \
  X(PKY2, 0) X(PKY3, 0) X(PKY4, 2) X(PKY5, 0) X(PKY6, 0) X(PKY7, 0) X(PHY1, 0) X(PHY2, 0) X(PHY3, 0) X(PVY1, 0) \
  X(PVY2, 0) X(PVY3, 0) X(PVY4, 0) X(PPY1, 0) X(PPY2, 0) X(PPY3, 0) X(PPY4, 0) X(PPY5, 0) \
  X(RBY1, 0) X(RBY2, 0) X(RBY3, 0) X(RBY4, 0) X(RCY1, 0) X(REY1, 0) X(REY2, 0) X(RHY1, 0) X(RHY2, 0) X(RVY1, 0) \
  X(RVY2, 0) X(RVY3, 0) X(RVY4, 0) X(RVY5, 0) X(RVY6, 0) \
  X(QBZ1, 0) X(QBZ2, 0) X(QBZ3, 0) X(QBZ4, 0) X(QBZ5, 0) X(QBZ6, 0) X(QBZ9, 0) X(QBZ10, 0) X(QCZ1, 0) X(QDZ1, 0) \
  X(QDZ2, 0) X(QDZ3, 0) X(QDZ4, 0) X(QDZ6, 0) X(QDZ7, 0) X(QDZ8, 0) X(QDZ9, 0) X(QDZ10, 0) X(QDZ11, 0) X(QEZ1, 0) \
  X(QEZ2, 0) X(QEZ3, 0) X(QEZ4, 0) X(QEZ5, 0) X(QHZ1, 0) X(QHZ2, 0) X(QHZ3, 0) X(QHZ4, 0) X(PPZ1, 0) X(PPZ2, 0) \
  X(SSZ1, 0) X(SSZ2, 0) X(SSZ3, 0) X(SSZ4, 0) \
  X(QSX1, 0) X(QSX2, 0) X(QSX3, 0) X(QSX4, 0) X(QSX5, 0) X(QSX6, 0) X(QSX7, 0) X(QSX8, 0) X(QSX9, 0) X(QSX10, 0) \
  X(QSX11, 0) X(QSX12, 0) X(QSX13, 0) X(QSX14, 0) X(PPMX1, 0) \
  X(QSY1, 0) X(QSY2, 0) X(QSY3, 0) X(QSY4, 0) X(QSY5, 0) X(QSY6, 0) X(QSY7, 0) X(QSY8, 0)
/* clang-format on */

enum {
#define ALI3_MAGIC_NAME(name, value) ALI3_MF_##name,
  ALI3_MAGIC_COEFFICIENTS(ALI3_MAGIC_NAME)
#undef ALI3_MAGIC_NAME
      ALI3_MF_COUNT
};

enum { ALI3_MAGIC_PAC2002 = 52, ALI3_MAGIC_61 = 61, ALI3_MAGIC_62 = 62 };
/* Combined slip: none (pure slip of each direction), weighting functions of the formula, friction ellipse. */
enum { ALI3_MAGIC_UNCOMBINED, ALI3_MAGIC_WEIGHTED, ALI3_MAGIC_ELLIPSE, ALI3_MAGIC_COMBINATIONS };

typedef struct {
  const double *c; /* coefficients by ALI3_MF_... */
  int32_t version, combined; /* ALI3_MAGIC_PAC2002, _61 or _62; ALI3_MAGIC_UNCOMBINED, _WEIGHTED or _ELLIPSE */
  double nominal_load, radius; /* N, m: FNOMIN, UNLOADED_RADIUS */
  double load, camber, pressure; /* N, > 0; rad, axes of the file; pressure / nominal pressure - 1 */
  double friction[2]; /* factors on the peaks of the forces, beside LMUX and LMUY */
  double stiffness[2]; /* factors on the slip stiffnesses, beside LKX and LKY */
  double moving; /* factor on shifts, camber thrust and moments: 0 at rest to 1 */
  double direction; /* of travel: 1, -1 backwards */
  double speed, slide; /* m/s: speed of travel, sliding speed of the patch */
} ali3_magic_state;

typedef struct {
  double F[2]; /* N, axes of the file: along, lateral */
  double J[2][2]; /* derivatives of F with respect to longitudinal slip and tan(slip angle) */
  double secant[2], secant_slope[2][2]; /* |F| / slip without shifts, and its derivatives */
  double peak[2]; /* N: largest |F| of each direction at pure slip */
  double cornering; /* cornering stiffness, N per unit of tan(slip angle), > 0 */
  double carcass[2]; /* carcass stiffness, N/m */
  double trail, arm; /* lever of the lateral and of the longitudinal force, m */
  double Mx, My, Mz; /* N m, axes of the file; My > 0 resists rolling */
} ali3_magic_force;

/* Forces and Mz; Mx and My stay unset. kappa: longitudinal slip; tangent: tangent of the slip angle, axes of the
 * file. */
void ali3_magic_forces(const ali3_magic_state *s, double kappa, double tangent, ali3_magic_force *out);

/* Mx, My and Mz at the acting forces F instead of the steady ones. */
void ali3_magic_moments(const ali3_magic_state *s, const double acting[2], ali3_magic_force *out);

/* Effective rolling radius, m, at a free radius (m, including growth by speed), stiffness at the nominal load (N/m) and
 * deflection (m). `stiffness_ratio`: local stiffness / that stiffness. */
double ali3_magic_rolling_radius(const ali3_magic_state *s, double free_radius, double stiffness, double deflection,
                                 double stiffness_ratio);
#endif
