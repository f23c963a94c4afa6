"""From a scenario to its rubble."""

from __future__ import annotations

import math

from cosim.scenario.scenario import Scenario
from coupling.interface import Structure
from coupling.rubble_port import RubblePort
from lattice.grid import Grid
from rubble.domain import Domain
from rubble.initial import Initial
from rubble.physics import RubblePhysics


def filling_rate(scenario: Scenario) -> float:
    """Part of the head on a wet top that comes per second, on the sheet as on blocks [1/s]."""
    r = scenario.rubble
    rates: dict[str, float] = {"full": math.inf, "none": 0.0, "filling": 1.0 / r.filling_time}
    return rates[r.backfill]


def build_rubble(scenario: Scenario, structure: Structure, grid: Grid) -> RubblePort:
    """The rubble: blocks in sections of whole node columns, in a domain that ends behind the structure."""
    r, i = scenario.rubble, scenario.ice
    depth = math.inf if scenario.water.depth is None else float(scenario.water.depth)
    physics = RubblePhysics(
        rho_i=i.density,
        rho_w=scenario.water.density,
        g=scenario.water.gravity,
        mu_ice_ice=r.friction_ice_ice,
        mu_structure=r.friction_structure,
        mu_bed=r.friction_sea_bed,
        restitution=r.restitution,
        form_drag=r.form_drag,
        skin_drag=r.skin_drag,
        added_mass=r.added_mass,
        added_inertia=r.added_mass,
        depth=depth,
        thickness=i.thickness,
        iterations=r.iterations,
        substep=r.substep,
        threads=r.threads,
        backfill=r.backfill,
        filling_time=r.filling_time,
        contact_strength=i.compressive_strength if r.contact_strength is None else r.contact_strength,
        current=scenario.water.current or (0.0, 0.0),
        flexural_strength=flexural_strength(scenario),
        breaking_time=breaking_time(scenario),
    )
    origin, pitch = sections_of(scenario)
    half_width = max(-grid.y0, grid.y0 + (grid.ny - 1) * grid.d)
    lowest = max(20.0 * i.thickness, scenario.water.depth or 0.0)  # on the bed nothing is lost
    domain = Domain(x_max=structure.reach + 2.0 * i.thickness, depth=lowest, y_max=half_width + pitch)
    return RubblePort(
        structure,
        physics,
        pitch=pitch,
        origin=origin,
        domain=domain,
    )


def initial_rubble(scenario: Scenario) -> Initial:
    """What is asked of the rubble of earlier ice."""
    r = scenario.rubble
    lengths = (float(r.initial_lengths[0]), float(r.initial_lengths[1]))
    return Initial(r.initial_volume, scenario.scenario.seed, r.initial_porosity, lengths, r.initial_slope)


def sections_of(scenario: Scenario) -> tuple[float, float]:
    """Y of section 0 and width of the sections of whole node columns [m]."""
    d = scenario.sheet.spacing
    pitch = scenario.rubble.columns_per_section * d
    return -scenario.sheet.axis + 0.5 * (pitch - d), pitch


def flexural_strength(scenario: Scenario) -> float:
    """At which pieces break again [Pa]."""
    r, i = scenario.rubble, scenario.ice
    known = [s for s in (r.flexural_strength, i.flexural_strength, i.tensile_strength) if s is not None]
    return float(known[0]) if r.breaks_again else math.inf


def breaking_time(scenario: Scenario) -> float:
    """Over which the loads that bend a piece are averaged [s]: half that of gravity over its thickness."""
    given: float | None = scenario.rubble.breaking_time
    return 0.5 * math.sqrt(scenario.ice.thickness / scenario.water.gravity) if given is None else given
