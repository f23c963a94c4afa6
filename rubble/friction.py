"""Friction of a contact by the pair, by the speed of slip, and by the third dimension.

A section knows only the plane y. The face of the structure at the point of contact has the unit normal n, see `cut`;
its part in the plane has the length ``p = 1 / sqrt(1 + q^2)``, ``q = n_y / p``. With the true normal force N and the
true slip ``(v_s, s)``, v_s in the plane and s = v_y / p lateral, ``|s| = hypot(v_s, s)``, the contact force on a block
is

    in the plane, along the normal    N (p + mu n_y s / |s|)        = N_plane, what the solver finds
    in the plane, along the face      -mu N v_s / |s|
    lateral                           N (n_y - mu p s / |s|)

so the solver needs the coefficient ``mu (v_s / |s|) / (p + mu n_y s / |s|)``. On the axis of a cone it is mu.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Record, Records, record
from rubble.compiled import compiled
from rubble.physics import RATE_DEPENDENT, Friction

#: coefficient of a pair (negative: rate-dependent), and y of the section [m]
LAW = record("mu", "y")
#: Slip below which a contact counts as sticking in the plane [m/s]. The lateral part of friction, s / |s|, has no
#: limit for a block at rest; with this it goes to 0. Far below any drift of ice (0.1 m/s and more), far above the noise
#: of a resting contact.
CREEP = 1e-4
#: A block may stand farther from the middle plane than the radius of its section's face: its centre lies beside the
#: slice. There the true face has no point; the normal of the farthest flank that still looks against the drift counts,
#: at this part of the radius (72 degrees round from the front, where n_y / n_x = 3).
FLANK = 0.95
#: Least part of N that presses in the plane. It is reached where friction outweighs the normal, on flanks that a block
#: would climb by its lateral slip alone, and keeps the solver's coefficient finite.
LEAST_PLANE = 1e-3


class Tilt(NamedTuple):
    """A face's unit normal out of the section's plane."""

    p: float  #: length of its part in the plane
    n_y: float


class Split(NamedTuple):
    """A contact force on the structure, in terms of what the solver finds in the plane."""

    mu: float  #: coefficient of the pair at its speed of slip
    true: float  #: N / N_plane
    lateral: float  #: s / |s|, part of the friction that acts laterally


@compiled("float64(float64)", nogil=True)
def rate_dependent(v: float) -> float:
    """Mu = 0.7 - 0.15 log10(v / 1e-6 m/s), between 1e-6 and 1e-2 m/s (Lishman and Polojarvi 2015)."""
    return 0.7 - 0.15 * np.log10(min(max(abs(v), 1e-6), 1e-2) / 1e-6)  # type: ignore[no-any-return]


@compiled(nogil=True)
def coefficient(law: Record, slip: float) -> float:
    """Coefficient of a pair at a speed of slip [m/s]."""
    mu: float = law.mu if law.mu >= 0.0 else rate_dependent(slip)
    return mu


@compiled(nogil=True)
def lateral_ratio(face: Record, x: float, y_section: float, y: float) -> float:
    """n_y / n_x of a face at x in the section y_section, for a block that stands at y.

    The radius is that of the section's face; y / x is taken where the block's own y meets the same radius.
    """
    r = np.hypot(x, y_section)
    ratio: float = face.constant
    if r == 0.0:
        return ratio
    out = min(max(y, -FLANK * r), FLANK * r)
    ratio += face.radial * (out / np.copysign(np.sqrt(r * r - out * out), x))
    return ratio


@compiled(nogil=True)
def tilt(face: Record, x: float, n_x: float, y_section: float, y: float) -> Tilt:
    """The normal at x of a `cut.FACE` whose normal in the plane is (n_x, n_z), for a block that stands at y."""
    q = lateral_ratio(face, x, y_section, y) * n_x
    p = 1.0 / np.sqrt(1.0 + q * q)
    return Tilt(p, q * p)


@compiled(nogil=True)
def split(law: Record, face: Tilt, v_s: float, v_y: float) -> Split:
    """How the force of a contact with the structure lies, with its slip v_s in the plane and laterally v_y [m/s]."""
    s = v_y / face.p
    speed = np.sqrt(v_s * v_s + s * s)
    mu = coefficient(law, speed)
    lateral = s / np.sqrt(speed * speed + CREEP * CREEP)
    return Split(mu, 1.0 / max(face.p + mu * face.n_y * lateral, LEAST_PLANE), lateral)


def law_of(mu: Friction, y: float = 0.0) -> Records:
    """Law (1,) of a pair in the section y."""
    law = np.zeros(1, LAW)
    law["mu"], law["y"] = -1.0 if mu == RATE_DEPENDENT else float(mu), y
    return law
