"""What the lattice must tend to: the Mindlin-Reissner plate on a Kelvin foundation, thesis 2.4, 2.5 and Appendix 1.

A mode (m, n) of a simply supported plate is w = sin sin, phi_x = cos sin, phi_y = sin cos (A.1.1)-(A.1.3) with the
wave numbers k_x = m pi / Lx, k_y = n pi / Ly. Its amplitudes obey the same 3 x 3 system as a plane wave (2.43)-(2.45)
after phi -> i phi, so eigenfrequencies, dispersion and forced response share one matrix.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from lattice.grid import Array
from lattice.ice import Ice


def plate_stiffness(ice: Ice, kx: ArrayLike, ky: ArrayLike) -> Array:
    """Stiffness of the plate alone per unit area for (w, phi_x, phi_y) at wave numbers kx, ky [1/m], (..., 3, 3)."""
    kx, ky = np.broadcast_arrays(np.asarray(kx, dtype=np.float64), np.asarray(ky, dtype=np.float64))
    S, D, nu = ice.shear_stiffness, ice.D, ice.nu
    K = np.empty((*kx.shape, 3, 3))
    K[..., 0, 0] = S * (kx**2 + ky**2)
    K[..., 0, 1] = K[..., 1, 0] = S * kx
    K[..., 0, 2] = K[..., 2, 0] = S * ky
    K[..., 1, 1] = S + D * (kx**2 + 0.5 * (1.0 - nu) * ky**2)
    K[..., 2, 2] = S + D * (ky**2 + 0.5 * (1.0 - nu) * kx**2)
    K[..., 1, 2] = K[..., 2, 1] = 0.5 * D * (1.0 + nu) * kx * ky
    return K


def plate_mass(ice: Ice) -> Array:
    """Rho h and twice rho h^3 / 12, left sides of (2.18)-(2.20), (3,)."""
    m = ice.rho_i * ice.h
    return m * np.array([1.0, ice.h**2 / 12.0, ice.h**2 / 12.0])


def dispersion(ice: Ice, kx: ArrayLike, ky: ArrayLike) -> Array:
    """Angular frequencies of the three branches, roots of the determinant of (2.43)-(2.45), (..., 3) [rad/s], rising.

    At long waves the first is the deflection wave, the other two are the rotational waves.
    """
    K = plate_stiffness(ice, kx, ky)
    K[..., 0, 0] += ice.k_f
    scale = 1.0 / np.sqrt(plate_mass(ice))
    return np.asarray(np.sqrt(np.linalg.eigvalsh(K * scale[:, None] * scale)))


def eigenfrequencies(ice: Ice, Lx: float, Ly: float, count: int) -> Array:
    """Lowest frequencies of the simply supported plate on the foundation, (count,) [Hz]; left column of Table 2-2."""
    order = count + 1  # mode (m, n) has at least m*n - 1 modes below it, so count of each is enough
    m, n = np.indices((order, order)) + 1
    kx, ky = (m * np.pi / Lx).astype(np.float64), (n * np.pi / Ly).astype(np.float64)
    branch = dispersion(ice, kx, ky)[..., 0]
    return np.sort(branch.ravel())[:count] / (2.0 * np.pi)


def navier(
    ice: Ice,
    sides: tuple[float, float],
    load_at: tuple[float, float],
    at: Array,
    omega: Array | float,
    c: float = 0.0,
    alpha: float = 0.0,
    terms: tuple[int, int] | None = None,
) -> Array:
    """Response of the simply supported plate to a unit point load cos(omega t), (A.1.8)-(A.1.10).

    ``sides`` and ``load_at`` in m, ``at`` (points, 2) [m], ``omega`` (frequencies,) [rad/s], ``c`` hydrodynamic damping
    [N s/m3], ``alpha`` stiffness-proportional damping [s]. Returns complex (frequencies, points, 3): w [m/N], phi_x,
    phi_y [1/N]. Right under a point load the shear part of w grows with the logarithm of the number of terms (0.2 %
    for each doubling): by default the series ends where the half wave is as short as the plate is thick.
    """
    terms = terms or (round(sides[0] / ice.h), round(sides[1] / ice.h))
    k = [np.pi * np.arange(1, count + 1) / L for count, L in zip(terms, sides, strict=True)]
    K = plate_stiffness(ice, k[0][:, None], k[1][None, :])
    load = np.outer(np.sin(k[0] * load_at[0]), np.sin(k[1] * load_at[1])) * 4.0 / (sides[0] * sides[1])
    sx, cx = np.sin(np.outer(at[:, 0], k[0])), np.cos(np.outer(at[:, 0], k[0]))
    sy, cy = np.sin(np.outer(at[:, 1], k[1])), np.cos(np.outer(at[:, 1], k[1]))
    out = np.empty((np.size(omega), len(at), 3), dtype=complex)
    for i, w in enumerate(np.atleast_1d(omega)):
        A = _amplitudes(K * (1.0 + 1j * alpha * w), plate_mass(ice) * w**2, ice.k_f + 1j * w * c) * load[..., None]
        for component, (fx, fy) in enumerate(((sx, sy), (cx, sy), (sx, cy))):
            out[i, :, component] = np.einsum("pm,mn,pn->p", fx, A[..., component], fy)
    return out


def _amplitudes(K: Array, inertia: Array, foundation: complex) -> Array:
    """Amplitudes of (w, phi_x, phi_y) of every mode under a unit modal load on w, by Cramer's rule, (..., 3)."""
    a = K[..., 0, 0] - inertia[0] + foundation
    b, c = K[..., 0, 1], K[..., 0, 2]
    d, e, f = K[..., 1, 1] - inertia[1], K[..., 2, 2] - inertia[2], K[..., 1, 2]
    determinant = a * (d * e - f**2) - b * (b * e - c * f) + c * (b * f - c * d)
    return np.asarray(np.stack((d * e - f**2, c * f - b * e, b * f - c * d), axis=-1) / determinant[..., None])


def hydrodynamic_damping(ice: Ice, fraction: float) -> float:
    """C as a fraction of sqrt(k_s rho h), the scale of sections 2.5.3 and 4.2.1 [N s/m3]."""
    return fraction * float(np.sqrt(ice.k_f * ice.rho_i * ice.h))
