"""The Magic Formula by the published equations, independent of the kernel; axes of the coefficients.

`pac2002`: H. B. Pacejka, Tire and Vehicle Dynamics, 2nd ed., Elsevier, 2006, section 4.3.2, as PAC2002 and MF-Tyre 5.2
have it, with angles for their tangents; the friction ellipse is that of PAC2002. `mf6`: the same, 3rd ed., 2012,
section 4.3.2, equations 4.E1 to 4.E78, without turn slip; I. J. M. Besselink, A. J. C. Schmeitz, H. B. Pacejka, Vehicle
System Dynamics 48(S1), 2010, 337-352, for QSX12 to QSX14. Slips and load are within the ranges of the file.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import atan, cos, exp, hypot, pi, sin, sqrt, tan

from mbs.kernel.header.magic_coefficients import MAGIC_COEFFICIENTS


@dataclass(frozen=True)
class Forces:
    """Forces, N, and moments, N m; My resists rolling where it is positive."""

    Fx: float
    Fy: float
    Mx: float
    My: float
    Mz: float


@dataclass(frozen=True)
class Operation:
    """Operating point of a tyre: load, N, slip, slip angle, rad, camber, rad, speed, m/s, pressure ratio less 1,
    friction.
    """

    Fz: float
    kappa: float
    alpha: float
    gamma: float
    V: float
    dpi: float = 0.0
    mu: float = 1.0


class Coefficients:
    """Coefficients as attributes; those not given have their usual value."""

    def __init__(self, coefficients: Mapping[str, float], R0: float, Fz0: float) -> None:
        self.__dict__.update({**MAGIC_COEFFICIENTS, **coefficients})
        self.R0, self.Fz0 = R0, Fz0

    def __getattr__(self, name: str) -> float:
        raise AttributeError(name)


def sgn(x: float) -> float:
    return -1.0 if x < 0.0 else 1.0


def pac2002(p: Coefficients, g: Operation, combination: str) -> Forces:
    """PAC2002 and MF-Tyre 5.2."""
    Fz, kappa, alpha, gamma, dpi = g.Fz, g.kappa, g.alpha, g.gamma, g.dpi
    Fz0 = p.Fz0 * p.LFZO
    dfz = (Fz - Fz0) / Fz0
    LMUX, LMUY = p.LMUX * g.mu, p.LMUY * g.mu

    gx = gamma * p.LGAX
    SHx = (p.PHX1 + p.PHX2 * dfz) * p.LHX
    kx = kappa + SHx
    Cx = p.PCX1 * p.LCX
    mux = (p.PDX1 + p.PDX2 * dfz) * (1 + p.PPX3 * dpi + p.PPX4 * dpi**2) * (1 - p.PDX3 * gx**2) * LMUX
    Dx = mux * Fz
    Ex = min((p.PEX1 + p.PEX2 * dfz + p.PEX3 * dfz**2) * (1 - p.PEX4 * sgn(kx)) * p.LEX, 1.0)
    Kx = Fz * (p.PKX1 + p.PKX2 * dfz) * exp(p.PKX3 * dfz) * (1 + p.PPX1 * dpi + p.PPX2 * dpi**2) * p.LKX
    Bx = Kx / (Cx * Dx)
    SVx = Fz * (p.PVX1 + p.PVX2 * dfz) * p.LVX * LMUX
    Fx0 = Dx * sin(Cx * atan(Bx * kx - Ex * (Bx * kx - atan(Bx * kx)))) + SVx

    gy = gamma * p.LGAY
    SHy = (p.PHY1 + p.PHY2 * dfz) * p.LHY + p.PHY3 * gy * p.LKYC
    ay = alpha + SHy
    Cy = p.PCY1 * p.LCY
    muy = (p.PDY1 + p.PDY2 * dfz) * (1 + p.PPY3 * dpi + p.PPY4 * dpi**2) * (1 - p.PDY3 * gy**2) * LMUY
    Dy = muy * Fz
    Ey = min((p.PEY1 + p.PEY2 * dfz) * (1 - (p.PEY3 + p.PEY4 * gy) * sgn(ay)) * p.LEY, 1.0)
    Ky0 = p.PKY1 * Fz0 * (1 + p.PPY1 * dpi) * sin(2 * atan(Fz / (p.PKY2 * Fz0 * (1 + p.PPY2 * dpi)))) * p.LKY
    Ky = Ky0 * (1 - p.PKY3 * abs(gy))
    By = Ky / (Cy * Dy)
    SVy = Fz * ((p.PVY1 + p.PVY2 * dfz) * p.LVY + (p.PVY3 + p.PVY4 * dfz) * gy * p.LKYC) * LMUY
    Fy0 = Dy * sin(Cy * atan(By * ay - Ey * (By * ay - atan(By * ay)))) + SVy

    SVyk = 0.0
    if combination == "weighting":
        Bxa = p.RBX1 * cos(atan(p.RBX2 * kappa)) * p.LXAL
        Cxa, Exa, SHxa = p.RCX1, min(p.REX1 + p.REX2 * dfz, 1.0), p.RHX1
        a_s = alpha + SHxa
        Dxa = Fx0 / cos(Cxa * atan(Bxa * SHxa - Exa * (Bxa * SHxa - atan(Bxa * SHxa))))
        Fx = Dxa * cos(Cxa * atan(Bxa * a_s - Exa * (Bxa * a_s - atan(Bxa * a_s))))
        Byk = p.RBY1 * cos(atan(p.RBY2 * (alpha - p.RBY3))) * p.LYKA
        Cyk, Eyk, SHyk = p.RCY1, min(p.REY1 + p.REY2 * dfz, 1.0), p.RHY1 + p.RHY2 * dfz
        ks = kappa + SHyk
        Dyk = Fy0 / cos(Cyk * atan(Byk * SHyk - Eyk * (Byk * SHyk - atan(Byk * SHyk))))
        DVyk = muy * Fz * (p.RVY1 + p.RVY2 * dfz + p.RVY3 * gamma) * cos(atan(p.RVY4 * alpha))
        SVyk = DVyk * sin(p.RVY5 * atan(p.RVY6 * kappa)) * p.LVYKA
        Fy = Dyk * cos(Cyk * atan(Byk * ks - Eyk * (Byk * ks - atan(Byk * ks)))) + SVyk
    elif combination == "ellipse":
        kc, ac = kappa + SHx + SVx / Kx, sin(alpha + SHy + SVy / Ky)
        mux_act, muy_act, mux_max, muy_max = (Fx0 - SVx) / Fz, (Fy0 - SVy) / Fz, Dx / Fz, Dy / Fz
        tan_beta = abs(ac / kc)
        Fx = Fx0 / mux_act * sgn(mux_act) / hypot(1 / mux_act, tan_beta / muy_max)
        Fy = Fy0 / muy_act * sgn(muy_act) * tan_beta / hypot(1 / mux_max, tan_beta / muy_act)
    else:
        Fx, Fy = Fx0, Fy0

    gz = gamma * p.LGAZ
    SHt = p.QHZ1 + p.QHZ2 * dfz + (p.QHZ3 + p.QHZ4 * dfz) * gz
    at, ar = alpha + SHt, alpha + SHy + SVy / Ky
    Bt = (p.QBZ1 + p.QBZ2 * dfz + p.QBZ3 * dfz**2) * (1 + p.QBZ4 * gz + p.QBZ5 * abs(gz)) * p.LKY / LMUY
    Ct = p.QCZ1
    Dt = Fz * (p.QDZ1 + p.QDZ2 * dfz) * (1 - p.PPZ1 * dpi) * (1 + p.QDZ3 * gz + p.QDZ4 * gz**2) * p.R0 / Fz0 * p.LTR
    Et = (p.QEZ1 + p.QEZ2 * dfz + p.QEZ3 * dfz**2) * (1 + (p.QEZ4 + p.QEZ5 * gz) * 2 / pi * atan(Bt * Ct * at))
    Et = min(Et, 1.0)
    Br = p.QBZ9 * p.LKY / LMUY + p.QBZ10 * By * Cy
    Dr = (p.QDZ6 + p.QDZ7 * dfz) * p.LRES + (p.QDZ8 + p.QDZ9 * dfz) * (1 + p.PPZ2 * dpi) * gz * p.LKZC
    Dr *= Fz * p.R0 * LMUY
    long = Kx / Ky * kappa if combination == "weighting" else 0.0
    at_eq = atan(sqrt(tan(at) ** 2 + long**2)) * sgn(at)
    ar_eq = atan(sqrt(tan(ar) ** 2 + long**2)) * sgn(ar)
    t = Dt * cos(Ct * atan(Bt * at_eq - Et * (Bt * at_eq - atan(Bt * at_eq)))) * cos(alpha)
    Mzr = Dr * cos(atan(Br * ar_eq)) * cos(alpha)
    s = (p.SSZ1 + p.SSZ2 * Fy / Fz0 + (p.SSZ3 + p.SSZ4 * dfz) * gamma) * p.R0 * p.LS
    Mz = -t * (Fy - SVyk) + Mzr + s * Fx
    return Forces(Fx, Fy, _mx(p, g, Fy), _my(p, g, Fx, Fz), Mz)


def mf6(p: Coefficients, g: Operation, combination: str) -> Forces:
    """MF-Tyre 6.1 and 6.2."""
    Fz, kappa, dpi = g.Fz, g.kappa, g.dpi
    Fz0 = p.LFZO * p.Fz0  # 4.E1
    dfz = (Fz - Fz0) / Fz0  # 4.E2a
    a, gam = tan(g.alpha), sin(g.gamma)  # 4.E3, 4.E4
    Vs = g.V * hypot(kappa, a)
    fade = 1 + p.LMUV * Vs / p.LONGVL
    lx, ly = p.LMUX * g.mu / fade, p.LMUY * g.mu / fade  # 4.E7
    lx_, ly_ = 10 * lx / (1 + 9 * lx), 10 * ly / (1 + 9 * ly)  # 4.E8

    def pure_x() -> tuple[float, float]:
        Cx = p.PCX1 * p.LCX  # 4.E11
        mux = (p.PDX1 + p.PDX2 * dfz) * (1 + p.PPX3 * dpi + p.PPX4 * dpi**2) * (1 - p.PDX3 * gam**2) * lx  # 4.E13
        Dx = mux * Fz  # 4.E12
        SHx = (p.PHX1 + p.PHX2 * dfz) * p.LHX  # 4.E17
        kx = kappa + SHx  # 4.E10
        Ex = (p.PEX1 + p.PEX2 * dfz + p.PEX3 * dfz**2) * (1 - p.PEX4 * sgn(kx)) * p.LEX  # 4.E14
        Ex = min(Ex, 1.0)
        Kx = Fz * (p.PKX1 + p.PKX2 * dfz) * exp(p.PKX3 * dfz) * (1 + p.PPX1 * dpi + p.PPX2 * dpi**2) * p.LKX  # 4.E15
        Bx = Kx / (Cx * Dx)  # 4.E16
        SVx = Fz * (p.PVX1 + p.PVX2 * dfz) * p.LVX * lx_  # 4.E18
        return Dx * sin(Cx * atan(Bx * kx - Ex * (Bx * kx - atan(Bx * kx)))) + SVx, Kx  # 4.E9

    def pure_y(gam: float) -> dict[str, float]:
        Cy = p.PCY1 * p.LCY  # 4.E21
        muy = (p.PDY1 + p.PDY2 * dfz) * (1 + p.PPY3 * dpi + p.PPY4 * dpi**2) * (1 - p.PDY3 * gam**2) * ly  # 4.E23
        Dy = muy * Fz  # 4.E22
        z = (Fz / Fz0) / ((p.PKY2 + p.PKY5 * gam**2) * (1 + p.PPY2 * dpi))
        Ky = p.PKY1 * Fz0 * (1 + p.PPY1 * dpi) * (1 - p.PKY3 * abs(gam)) * sin(p.PKY4 * atan(z)) * p.LKY  # 4.E25
        SVyg = Fz * (p.PVY3 + p.PVY4 * dfz) * gam * p.LKYC * ly_  # 4.E28
        Kyg0 = Fz * (p.PKY6 + p.PKY7 * dfz) * (1 + p.PPY5 * dpi) * p.LKYC  # 4.E30
        SHy = (p.PHY1 + p.PHY2 * dfz) * p.LHY + (Kyg0 * gam - SVyg) / Ky  # 4.E27
        SVy = Fz * (p.PVY1 + p.PVY2 * dfz) * p.LVY * ly_ + SVyg  # 4.E29
        ay = a + SHy  # 4.E20
        Ey = (p.PEY1 + p.PEY2 * dfz) * (1 + p.PEY5 * gam**2 - (p.PEY3 + p.PEY4 * gam) * sgn(ay)) * p.LEY  # 4.E24
        Ey = min(Ey, 1.0)
        By = Ky / (Cy * Dy)  # 4.E26
        Fy0 = Dy * sin(Cy * atan(By * ay - Ey * (By * ay - atan(By * ay)))) + SVy  # 4.E19
        return {"F": Fy0, "K": Ky, "SH": SHy, "SV": SVy, "BC": By * Cy, "D": Dy}

    def Gyk(gam: float) -> float:
        Byk = (p.RBY1 + p.RBY4 * gam**2) * cos(atan(p.RBY2 * (a - p.RBY3))) * p.LYKA  # 4.E62
        Cyk, Eyk = p.RCY1, min(p.REY1 + p.REY2 * dfz, 1.0)  # 4.E63, 4.E64
        SHyk = p.RHY1 + p.RHY2 * dfz  # 4.E65
        ks = kappa + SHyk  # 4.E61
        below = cos(Cyk * atan(Byk * SHyk - Eyk * (Byk * SHyk - atan(Byk * SHyk))))  # 4.E60
        return cos(Cyk * atan(Byk * ks - Eyk * (Byk * ks - atan(Byk * ks)))) / below  # 4.E59

    Fx0, Kx = pure_x()
    y, y0 = pure_y(gam), pure_y(0.0)
    if combination == "weighting":
        Bxa = (p.RBX1 + p.RBX3 * gam**2) * cos(atan(p.RBX2 * kappa)) * p.LXAL  # 4.E54
        Cxa, Exa, SHxa = p.RCX1, min(p.REX1 + p.REX2 * dfz, 1.0), p.RHX1  # 4.E55 to 4.E57
        a_s = a + SHxa  # 4.E53
        below = cos(Cxa * atan(Bxa * SHxa - Exa * (Bxa * SHxa - atan(Bxa * SHxa))))  # 4.E52
        Gxa = cos(Cxa * atan(Bxa * a_s - Exa * (Bxa * a_s - atan(Bxa * a_s)))) / below  # 4.E51
        DVyk = y["D"] * (p.RVY1 + p.RVY2 * dfz + p.RVY3 * gam) * cos(atan(p.RVY4 * a))  # 4.E67
        SVyk = DVyk * sin(p.RVY5 * atan(p.RVY6 * kappa)) * p.LVYKA  # 4.E66
        Fx, Fy, F_ = Gxa * Fx0, Gyk(gam) * y["F"] + SVyk, Gyk(0.0) * y0["F"]  # 4.E50, 4.E58, 4.E74
    else:
        assert combination == "none"
        Fx, Fy, F_ = Fx0, y["F"], y0["F"]

    cos_a = cos(g.alpha)  # 4.E6
    SHt = p.QHZ1 + p.QHZ2 * dfz + (p.QHZ3 + p.QHZ4 * dfz) * gam  # 4.E35
    at, ar = a + SHt, a + y["SH"] + y["SV"] / y["K"]  # 4.E34, 4.E37, 4.E38
    Bt = (p.QBZ1 + p.QBZ2 * dfz + p.QBZ3 * dfz**2) * p.LKY / ly
    Bt *= 1 + p.QBZ4 * gam + p.QBZ5 * abs(gam) + p.QBZ6 * gam**2  # 4.E40, with QBZ4 of MF-Tyre
    Ct = p.QCZ1  # 4.E41
    Dt0 = Fz * p.R0 / Fz0 * (p.QDZ1 + p.QDZ2 * dfz) * (1 - p.PPZ1 * dpi) * p.LTR  # 4.E42
    Dt = Dt0 * (1 + p.QDZ3 * abs(gam) + p.QDZ4 * gam**2)  # 4.E43
    Et = (p.QEZ1 + p.QEZ2 * dfz + p.QEZ3 * dfz**2) * (1 + (p.QEZ4 + p.QEZ5 * gam) * 2 / pi * atan(Bt * Ct * at))
    Et = min(Et, 1.0)  # 4.E44
    Br = p.QBZ9 * p.LKY / ly + p.QBZ10 * y["BC"]  # 4.E45
    Dr = (p.QDZ6 + p.QDZ7 * dfz) * p.LRES
    Dr += ((p.QDZ8 + p.QDZ9 * dfz) * (1 + p.PPZ2 * dpi) + (p.QDZ10 + p.QDZ11 * dfz) * abs(gam)) * gam * p.LKZC
    Dr *= Fz * p.R0 * ly * cos_a  # 4.E47
    long = Kx / y["K"] * kappa if combination == "weighting" else 0.0
    at_eq, ar_eq = (hypot(x, long) * sgn(x) for x in (at, ar))  # 4.E77, 4.E78
    t = Dt * cos(Ct * atan(Bt * at_eq - Et * (Bt * at_eq - atan(Bt * at_eq)))) * cos_a  # 4.E73
    Mzr = Dr * cos(atan(Br * ar_eq))  # 4.E75
    s = p.R0 * (p.SSZ1 + p.SSZ2 * Fy / Fz0 + (p.SSZ3 + p.SSZ4 * dfz) * gam) * p.LS  # 4.E76
    Mz = -t * F_ + Mzr + s * Fx  # 4.E71, 4.E72
    return Forces(Fx, Fy, _mx(p, g, Fy), _my(p, g, Fx, p.Fz0 if p.QSY7 else Fz), Mz)


def _mx(p: Coefficients, g: Operation, Fy: float) -> float:
    """4.E69, with QSX12 to QSX14; over the nominal load without LFZO."""
    Fz, Fz0, gam = g.Fz, p.Fz0, g.gamma
    Mx = p.QSX1 * p.LVMX - p.QSX2 * gam * (1 + p.PPMX1 * g.dpi) - p.QSX12 * gam * abs(gam) + p.QSX3 * Fy / Fz0
    angle = p.QSX7 * gam + p.QSX8 * atan(p.QSX9 * Fy / Fz0)
    Mx += p.QSX4 * cos(p.QSX5 * atan((p.QSX6 * Fz / Fz0) ** 2)) * sin(angle)
    Mx += p.QSX10 * atan(p.QSX11 * Fz / Fz0) * gam
    return p.R0 * p.LMX * (Fz * Mx + Fy * (p.QSX13 + p.QSX14 * abs(gam)))


def _my(p: Coefficients, g: Operation, Fx: float, Fz1: float) -> float:
    """Positive against rolling; `Fz1`: of 4.E70 the load, of Besselink et al., A48, the nominal one."""
    Fz, v, gam = g.Fz, abs(g.V / p.LONGVL), g.gamma
    My = p.QSY1 + p.QSY2 * Fx / p.Fz0 + p.QSY3 * v + p.QSY4 * v**4 + p.QSY5 * gam**2 + p.QSY6 * Fz / p.Fz0 * gam**2
    return Fz1 * p.R0 * My * (Fz / p.Fz0) ** p.QSY7 * (1 + g.dpi) ** p.QSY8 * p.LMY
