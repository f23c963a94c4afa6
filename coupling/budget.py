"""The force budget: what carries the load of the ice on the structure, window by window.

By Newton's law for all ice, sheet and blocks, the mean force on the structure over a window is the sum of

====================  ===============================================================================================
``dry_tops``          water that blocks displace with tops that are pushed under and not yet flooded
``flooded_rubble``    buoyancy of the submerged volume of the blocks as if all tops were flooded, minus their weight
``pressed_sheet``     the foundation under the deflected sheet: its own lift, and what the rubble below it holds up
``drag``              of the water on blocks and sheet
``inertia``           minus the gain of momentum of blocks (with added mass) and sheet
``held``              the supports of the sheet: the thrust of its held edges (x only; nothing holds it in z)
``sea_bed``           of the sea bed on grounded blocks, only where there is one; minus it is the force on the bed
``staggering``        the rubble's force on the sheet that the sheet carried in this window, minus the one that the
                      blocks exerted in it
====================  ===============================================================================================

Named loads on the sheet have a term each; ``water_above`` and ``water_left_below`` are what the water does beyond the
linear foundation, see `lattice.tops`.

Every term is formed on its own: forces of the water and momentum from the participants, the load from the contacts.
What is left is ``residual``. It is rounding wherever the sheet's window is solved on its own; the sheet's means are
those of its scheme and the rubble's impulses are summed in every sub-step. In windows that are read off a long step it
is the error of that step, on the explicit engine that of the trapezoidal rule between two evaluations of the contact.

The staggering is no error of the sum but of the coupling: the sheet feels the rubble of the window before. Over time it
telescopes to the force of one window, but for what nodes should have felt in the window in which they leave the
lattice: that is lost, and shows as a mean of this term.
"""

from __future__ import annotations

import numpy as np

from coupling.interface import Array, ForcePairs

TERMS = ("dry_tops", "flooded_rubble", "pressed_sheet", "drag", "inertia", "held", "staggering")
NAMED = ("sea_bed",)  #: only where a participant gives it
AXES = {"fx": 0, "fz": 1}  #: component of the load, its place in a pair


def force_budget(load: Array, *participants: ForcePairs, loads: ForcePairs | None = None) -> dict[str, float]:
    """Terms ``fx_dry_tops`` ... ``fz_staggering`` and residuals ``fx_residual``, ``fz_residual`` [N].

    ``load`` (3,) on the structure; each participant gives its own terms, those of the same name are added. Other
    ``loads`` on the sheet have a term each, under their names.
    """
    unknown = {name for terms in participants for name in terms} - {*TERMS, *NAMED}
    if unknown:
        raise ValueError(f"force budget: unknown terms {sorted(unknown)}; known are {', '.join(TERMS + NAMED)}")
    out: dict[str, float] = {}
    for axis, k in AXES.items():
        terms = {name: float(sum(p[name][k] for p in participants if name in p)) for name in TERMS}
        terms |= {name: p[name][k] for name in NAMED for p in participants if name in p}
        terms |= {name: pair[k] for name, pair in (loads or {}).items()}
        out.update({f"{axis}_{name}": value for name, value in terms.items()})
        out[f"{axis}_residual"] = float(load[2 * k]) - float(np.sum(list(terms.values())))
    return out
