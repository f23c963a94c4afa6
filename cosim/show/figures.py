"""Figures of a recorded run: loads by phase, masses, where the energy went."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from cosim.analysis.run_data import RunData
from cosim.show import budget_figure, motion_figure
from cosim.show.cells import over_text
from cosim.show.ice.palette import PHASE_COLOURS
from cosim.show.scale import scale_of
from coupling.energy import LIMIT, LOAD_WORK, MOVING
from coupling.interface import PHASES, Array

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = PHASE_COLOURS
#: where energy is or went: terms of `coupling.energy` that belong together, and their colour
ENERGY = {
    "crushing at the edge": ("#2f7ebc", ("contact_crushing_loss", "edge_crushed_loss")),
    "friction on structure": (
        "#7fb3dc",
        ("contact_friction_loss", "friction_structure_loss"),
    ),
    "sheet: damping, scheme": ("#9a9fa6", ("damping_loss", "scheme_loss")),
    "fracture, hand-over": (
        "#1d2733",
        (
            "fracture_loss",
            "breaking_again_loss",
            "handover_elastic_loss",
            "handover_potential_loss",
            "handover_kinetic_loss",
        ),
    ),
    "stored in the sheet": ("#8d6cab", ("sheet_elastic", "sheet_foundation", "sheet_kinetic")),
    "stored in the rubble": ("#e6812b", ("rubble_potential", "rubble_kinetic")),
    "rubble: friction, impact": (
        "#f2b880",
        (
            "impact_ice_loss",
            "impact_structure_loss",
            "impact_sheet_loss",
            "friction_ice_loss",
            "friction_sheet_loss",
            "impact_bed_loss",
            "friction_bed_loss",
        ),
    ),
    "water": ("#3a9b5c", ("drag_loss", "dry_top_loss")),
    "ice that left": ("#c9c24f", ("crushed_energy_loss", "cleared_energy_loss")),
    "interface, step, overlap": ("#d45087", ("interface_loss", "stepping_loss", "correction_loss")),
}
LOST: tuple[dict[str, Any], ...] = (
    {"color": "#0072b2", "lw": 1.6},
    {"color": "#d55e00", "lw": 1.6, "ls": (0, (5, 2))},
    {"color": "#1d2733", "lw": 1.6, "ls": (0, (1, 1.5))},
)
ICE = ("sheet_mass", "rubble_mass", "crushed_mass", "cleared_mass")


def has_data(title: str, run: RunData) -> bool:
    """Whether a figure has something to show: a recording may hold no balances and no force budget."""
    needs = {
        "drift": {"drift_work", "energy_residual"} <= set(run.ledger),
        "carries": bool(run.budget),
        "left": set(ICE[1:]) <= set(run.ledger),
        "Motion": bool(run.motion),
    }
    return all(there for word, there in needs.items() if word in title)


def draw_loads(figure: Figure, run: RunData, seconds: float | None = None) -> None:
    """Fx and Fz by phase, stacked, with the total as a line; means over a time [s], by default as the peaks are."""
    seconds = run.averaging if seconds is None else seconds
    over, run = over_text(seconds), run.averaged(seconds)
    scale = scale_of((np.abs(run.component(name)).max() for name in ("fx", "fz")), "N")
    axes = figure.subplots(2, 1, sharex=True)
    for ax, name, label in zip(axes, ("fx", "fz"), ("Fx", "Fz"), strict=True):
        phases = np.array([run.component(name, p) for p in PHASES]) / scale.size
        for side, labels in ((np.maximum, list(PHASES)), (np.minimum, ())):  # what presses down is stacked downwards
            ax.stackplot(run.t, side(phases, 0.0), colors=COLOURS.values(), labels=labels, alpha=0.75, lw=0)
        ax.plot(run.t, phases.sum(axis=0), "k", lw=0.7, label="total")
        ax.set_ylabel(f"{label} [{scale.unit}]")
        ax.grid(alpha=0.3)
    figure.legend(*axes[0].get_legend_handles_labels(), ncols=4, fontsize=8, loc="outside upper center")
    axes[1].set_xlabel(f"time [s]; means over {over}")
    axes[1].set_xlim(0.0, run.t[-1])


def draw_mass(figure: Figure, run: RunData) -> None:
    """Where the ice is that has left the sheet."""
    ax = figure.subplots()
    drawn = [name for name in ICE[1:] if name in run.ledger]
    scale = scale_of((np.nanmax(run.ledger[name]) for name in drawn), "kg")
    for name, look in zip(drawn, LOST, strict=False):
        ax.plot(run.t, run.ledger[name] / scale.size, label=name.removesuffix("_mass"), **look)
    ax.set(xlabel="time [s]", ylabel=f"mass [{scale.unit}]", xlim=(0.0, run.t[-1]))
    ax.legend()
    ax.grid(alpha=0.3)


def draw_energy(figure: Figure, run: RunData) -> None:
    """Where the drift's work is or went, what else put energy in (below zero), and what is not explained."""
    ax, low = figure.subplots(2, 1, sharex=True, height_ratios=(3.0, 1.0))
    loads = [name for name in run.ledger if name.endswith(LOAD_WORK)]
    joule = energy_group(run, ["drift_work", MOVING, *loads])
    scale = scale_of((np.nanmax(np.abs(joule)),), "J")
    work = joule / scale.size
    groups = {name: energy_group(run, names) / scale.size for name, (_, names) in ENERGY.items()}
    colours = [colour for colour, _ in ENERGY.values()]
    ax.stackplot(run.t, np.maximum(list(groups.values()), 0.0), labels=list(groups), colors=colours, lw=0)
    ax.stackplot(run.t, np.minimum(list(groups.values()), 0.0), colors=colours, lw=0)
    ax.plot(run.t, work, "w", lw=3.0)
    ax.plot(
        run.t,
        work,
        "k",
        lw=1.4,
        label="work of the drift" + ", of loads" * bool(loads) + ", of the structure" * (MOVING in run.ledger),
    )
    ax.axhline(0.0, color="k", lw=0.6)
    ax.text(0.01, 0.96, "below zero: energy put in beside the drift", transform=ax.transAxes, fontsize=8, va="top")
    ax.set(ylabel=f"energy [{scale.unit}]", xlim=(0.0, run.t[-1]))
    figure.legend(*ax.get_legend_handles_labels(), fontsize=8, loc="outside right upper")
    largest = np.maximum.accumulate(np.maximum(np.abs(work), 1e-6))
    low.semilogy(run.t, np.maximum(np.abs(run.ledger["energy_residual"]) / scale.size / largest, 1e-12), "k", lw=0.9)
    low.axhline(LIMIT, color="#b03a2e", lw=0.9, ls="--")
    low.text(0.01 * run.t[-1], LIMIT, "a run stops here", color="#b03a2e", fontsize=8, va="bottom")
    low.set(xlabel="time [s]", ylabel="residual / work", ylim=(1e-12, 1.0))
    for axes in (ax, low):
        axes.grid(alpha=0.3)


def energy_group(run: RunData, names: Sequence[str]) -> Array:
    """Sum of those terms that the run has, (windows,) [J]."""
    return np.asarray(np.sum([run.ledger[n] for n in names if n in run.ledger] or [np.zeros(len(run.t))], axis=0))


FIGURES: dict[str, Callable[[Any, RunData], None]] = {
    "Load on the structure by phase": draw_loads,
    "What carries the load": budget_figure.draw,
    "Ice that has left the sheet": draw_mass,
    "Where the work of the drift went": draw_energy,
    "Motion of the structure": motion_figure.draw,
}
