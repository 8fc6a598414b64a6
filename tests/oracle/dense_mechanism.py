"""A System as dense matrices, read from its arrays by plain loops: M, Phi, Phi_q, H, Q, and C and K of its springs."""

import numpy as np

SPRING_DAMPER = 1


class DenseMechanism:
    """Quadratic rows, gravity and two-point spring-dampers; anything else in the System is refused."""

    def __init__(self, system):
        a = system.arrays
        self.nq = nq = len(a["q0"])
        self.nc = nc = len(a["row_const"])
        for name in ("angle_row", "gterm_row", "input_start", "y0"):
            assert len(a[name]) == 0, f"the oracle has no {name}"

        self.M = np.zeros((nq, nq))
        for i in range(nq):
            for k in range(a["mass_ptr"][i], a["mass_ptr"][i + 1]):
                self.M[i, a["mass_col"][k]] = a["mass_val"][k]

        # Phi_k = c_k + l_k'q + 1/2 q'H_k q
        self.c = np.array(a["row_const"], float)
        self.l = np.zeros((nc, nq))
        self.H = np.zeros((nc, nq, nq))
        for k in range(nc):
            columns = a["row_col"][a["row_ptr"][k] : a["row_ptr"][k + 1]]
            for j, value in zip(columns, a["row_lin"][a["row_ptr"][k] : a["row_ptr"][k + 1]], strict=True):
                self.l[k, j] = value
            for t in range(a["quad_ptr"][k], a["quad_ptr"][k + 1]):
                i, j = columns[a["quad_a"][t]], columns[a["quad_b"][t]]
                self.H[k, i, j] += a["quad_h"][t]
                self.H[k, j, i] += a["quad_h"][t]

        self.gravity = np.array(a["gravity_force"], float)
        self.measure = np.array(a["row_measure"], float)
        self.springs = []
        for e in range(len(a["el_type"])):
            assert a["el_type"][e] == SPRING_DAMPER, f"the oracle has no element of type {a['el_type'][e]}"
            signals = a["el_sig"][a["el_sig_ptr"][e] : a["el_sig_ptr"][e + 1]]
            B, d0 = np.zeros((len(signals), nq)), np.zeros(len(signals))
            for row, s in enumerate(signals):
                d0[row] = a["sig_const"][s]
                for k in range(a["sig_ptr"][s], a["sig_ptr"][s + 1]):
                    B[row, a["sig_col"][k]] += a["sig_val"][k]
            stiffness, damping, free_length = a["el_parameter"][a["el_parameter_ptr"][e] :][:3]
            self.springs.append((B, d0, stiffness, damping, free_length))

    def Phi(self, q):
        return np.array([self.c[k] + self.l[k] @ q + 0.5 * q @ self.H[k] @ q for k in range(self.nc)])

    def Phiq(self, q):
        return np.array([self.l[k] + self.H[k] @ q for k in range(self.nc)]).reshape(self.nc, self.nq)

    def Phiqdot_qd(self, qd):
        """dPhi_q/dt qd."""
        return np.array([qd @ self.H[k] @ qd for k in range(self.nc)])

    def Q(self, q, qd):
        Q = self.gravity.copy()
        for B, d0, stiffness, damping, free_length in self.springs:
            d, dd = B @ q + d0, B @ qd
            length = np.linalg.norm(d)
            n = d / length
            Q -= B.T @ n * (stiffness * (length - free_length) + damping * (n @ dd))
        return Q

    def C(self, q, qd):
        """-dQ/dqd."""
        C = np.zeros((self.nq, self.nq))
        for B, d0, _, damping, _ in self.springs:
            n = (B @ q + d0) / np.linalg.norm(B @ q + d0)
            C += damping * B.T @ np.outer(n, n) @ B
        return C

    def K(self, q, qd):
        """Symmetric part of -dQ/dq."""
        K = np.zeros((self.nq, self.nq))
        for B, d0, stiffness, damping, free_length in self.springs:
            d, dd = B @ q + d0, B @ qd
            length = np.linalg.norm(d)
            n = d / length
            across = (np.eye(len(d)) - np.outer(n, n)) / length  # dn/dd
            tension = stiffness * (length - free_length) + damping * (n @ dd)
            slope = stiffness * np.outer(n, n) + damping * np.outer(n, across @ dd) + tension * across
            K += B.T @ (0.5 * (slope + slope.T)) @ B
        return K

    def geometric(self, lam):
        """sum_k lam_k H_k: derivative of Phi_q' lam."""
        return np.einsum("k,kij->ij", lam, self.H)
