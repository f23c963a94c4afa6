"""Table 2-2: eigenfrequencies of the simply supported plate on water, lattice and continuum.

Erratum: the continuum column of the table was computed with g = 9.80 m/s2, the lattice columns with 9.81 m/s2.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from cosim.verify.case import CaseResult, Quantity, near, value
from cosim.verify.plate import TABLE_2_1, ice_of, is_table_2_1, plate_of
from cosim.verify.settings import meshes
from lattice import continuum, spectrum

PARAMETERS: dict[str, Any] = {**TABLE_2_1, "nodes": [[19, 31], [31, 51], [61, 101]], "modes": 20}
SIX_DECIMALS = 5e-7  #: [Hz]
LAST_DIGIT = 1e-6  #: of the continuum column: its mode 19 is 6.39983547 Hz here and 6.399836 Hz in the table [Hz]

CONTINUUM = [
    0.655348,
    0.981122,
    1.586581,
    1.627973,
    2.003042,
    2.465026,
    2.633494,
    3.378501,
    3.519075,
    3.603406,
    3.757975,
    4.389615,
    4.655891,
    4.991826,
    5.271395,
    5.829436,
    6.038309,
    6.205250,
    6.399836,
    6.621979,
]
LATTICE = {
    (19, 31): [
        0.655400,
        0.980178,
        1.586147,
        1.632654,
        2.001152,
        2.470323,
        2.622802,
        3.409284,
        3.500945,
        3.624535,
        3.772677,
        4.379851,
        4.636690,
        5.044982,
        5.232394,
        5.933866,
        6.030671,
        6.280565,
        6.331901,
        6.730615,
    ],
    (31, 51): [
        0.655460,
        0.980844,
        1.586449,
        1.629670,
        2.002364,
        2.466879,
        2.629628,
        3.389306,
        3.512461,
        3.610731,
        3.762984,
        4.385800,
        4.648665,
        5.010098,
        5.256989,
        5.865418,
        6.034657,
        6.230735,
        6.374797,
        6.658921,
    ],
    (61, 101): [
        0.655486,
        0.981126,
        1.586592,
        1.628438,
        2.002905,
        2.465510,
        2.632550,
        3.381193,
        3.517431,
        3.605226,
        3.759215,
        4.388645,
        4.654066,
        4.996319,
        5.267768,
        5.838279,
        6.037315,
        6.211467,
        6.393525,
        6.631006,
    ],
}


def run(p: dict[str, Any], _quick: bool) -> CaseResult:
    """Eigenfrequencies of both lattices of Table 2-2 and of the plate, and the order of convergence."""
    ice, modes = ice_of(p), int(p["modes"])
    known = is_table_2_1(p) and 1 <= modes <= 20
    quantities = [value("continuum", continuum.eigenfrequencies(ice, p["Lx"], p["Ly"], modes), "Hz")]
    if known:
        quantities.append(_continuum(p))
    for nodes in meshes(p["nodes"]):
        found = spectrum.eigenfrequencies(plate_of(p, nodes), modes)
        reference = LATTICE[nodes][:modes] if known and nodes in LATTICE else None
        quantities.append(
            near(
                f"lattice {nodes[0]}x{nodes[1]}",
                found,
                "Hz",
                reference,
                SIX_DECIMALS,
                "van Vliet (2018), Table 2-2",
                "absolute",
            )
        )
    return CaseResult("eigenfrequencies", p, quantities)


def _continuum(p: dict[str, Any]) -> Quantity:
    found = continuum.eigenfrequencies(replace(ice_of(p), g=9.80), p["Lx"], p["Ly"], int(p["modes"]))
    return near(
        "continuum, g = 9.80",
        found,
        "Hz",
        CONTINUUM[: int(p["modes"])],
        LAST_DIGIT,
        "van Vliet (2018), Table 2-2; computed there with g = 9.80 m/s2",
        "absolute",
    )
