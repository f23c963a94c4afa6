"""From a field measurement to the strengths of the model, thesis 4.2.2: temperature, salinity and a beam test.

Two relations of the literature carry units that must be minded: brine volume is in parts per thousand, and the
Vaudrey (1977) relation, printed in the thesis with MPa, gives gigapascals.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lattice.ice import BeamTest, Ice
from lattice.specimens import factor_f


def brine_volume(salinity: float, temperature: float) -> float:
    """Frankenstein and Garner (1967): S in ppt, T in degrees Celsius from -22.9 to -0.5 -> brine volume [ppt]."""
    if not -22.9 <= temperature <= -0.5:
        raise ValueError(f"temperature {temperature:g} C: Frankenstein and Garner (1967) hold from -22.9 to -0.5 C")
    if salinity < 0.0:
        raise ValueError(f"salinity {salinity:g} ppt must not be negative")
    return salinity * (49.185 / abs(temperature) + 0.532)


def youngs_modulus(brine_ppt: float) -> float:
    """Vaudrey (1977): E = 5.316 - 0.436 sqrt(v_b) in GPa with v_b in ppt -> E [Pa]."""
    E = 5.316 - 0.436 * np.sqrt(brine_ppt)
    if not E > 0.0:
        raise ValueError(f"brine volume {brine_ppt:g} ppt: Vaudrey (1977) gives no stiffness above 148 ppt")
    return float(E) * 1e9


@dataclass(frozen=True)
class FieldMeasurement:
    """What a field party brings home: ice cover and a cantilever beam test."""

    thickness: float  #: h [m]
    salinity: float  #: S [ppt]
    temperature: float  #: T [degrees Celsius]
    beam_length: float  #: L_b [m]
    beam_width: float  #: w [m]
    failure_load: float  #: F_c [N]
    stress_relief: bool = False  #: holes drilled at the root
    E: float | None = None  #: measured Young's modulus; without it, from the brine volume [Pa]


def beam_strength(load: float, length: float, width: float, h: float) -> float:
    """Stress at the root of a clamped beam at failure, (4.27) [Pa]."""
    return 6.0 * load * length / (width * h**2)


def ice_from_field(
    field: FieldMeasurement,
    compressive_ratio: float = 5.0,
    nu: float = 1.0 / 3.0,
    rho_i: float = 920.0,
    rho_w: float = 1025.0,
    cells: int = 4,
) -> Ice:
    """Elastic sheet with its strengths from a field measurement, in one call.

    sigma_f is the beam stress (4.27), sigma_t the same (section 6.1) and sigma_c = ``compressive_ratio`` sigma_f
    (Table 4-2). Without stress relief holes the stress at the root was concentrated: the beam is simulated with
    ``cells`` over its width, and the factor f found there sets the limit beside a crack (4.31). With holes there was
    no concentration, and the limit beside a crack stays sigma_f.
    """
    E = youngs_modulus(brine_volume(field.salinity, field.temperature)) if field.E is None else field.E
    sigma_f = beam_strength(field.failure_load, field.beam_length, field.beam_width, field.thickness)
    ice = Ice(
        E=E,
        nu=nu,
        h=field.thickness,
        rho_i=rho_i,
        rho_w=rho_w,
        sigma_t=sigma_f,
        sigma_f=sigma_f,
        sigma_c=compressive_ratio * sigma_f,
    )
    if field.stress_relief:
        return ice
    f = factor_f(ice, field.beam_length, field.beam_width, cells, compressive_ratio)
    return replace(ice, beam_test=BeamTest(field.beam_length, field.beam_width, field.failure_load, f))
