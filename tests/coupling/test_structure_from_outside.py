"""A structure that coupling does not know, in a coupled run: a slope that the ice meets at an angle in the plan."""

import numpy as np
from threadpoolctl import threadpool_limits

import cosim.build
from cosim.scenario.loading import load_scenario
from coupling.interface import Phase
from coupling.structure import multi_sided_cone

BETA = 0.1  #: angle of the waterline against y [rad]
COT = 1.0 / np.tan(np.radians(30.0))


class ObliqueSlope:
    """x = z cot a + y tan beta, a slope that lifts ice and pushes it aside."""

    bottom, top, faces_down, half_width, reach = -5.0, 2.0, False, np.inf, 8.0

    def foremost_x(self, z):
        return float(self.face_x(-50.0, z))

    def face_x(self, y, z):
        y, z = np.broadcast_arrays(np.asarray(y, float), np.asarray(z, float))
        return np.where((self.bottom <= z) & (z <= self.top), COT * z + np.tan(BETA) * y, np.nan)

    def normal(self, y, z):
        n = np.array([-1.0, np.tan(BETA), COT])
        return np.where(np.isfinite(self.face_x(y, z))[..., None], n / np.linalg.norm(n), np.nan)

    def normal_z(self, z):
        return np.full(len(z), COT / np.hypot(np.hypot(1.0, np.tan(BETA)), COT))

    def overlap(self, x, y, z):
        face = self.face_x(y, z[:, None])
        normal = np.where(np.isfinite(face)[..., None], self.normal(y, z[:, None]), [-1.0, 0.0, 0.0])
        return np.nan_to_num(np.maximum(x[:, None] - face, 0.0)), normal

    def section(self, y, z_lo, z_hi, tolerance):
        z = np.array([max(z_lo, self.bottom), min(z_hi, self.top)])
        front = np.column_stack((self.face_x(y, z), z))
        return front, np.column_stack((np.full(2, front[:, 0].max() + 100.0), z))

    def generator(self, z_lo, z_hi):
        return None

    def bearing(self, x, y, z):
        return np.full(np.shape(x), -np.tan(BETA)), np.zeros(np.shape(x))

    def mesh(self, width):
        corners = [(y, z) for y in (-width / 2, width / 2) for z in (self.bottom, self.top)]
        points = np.array([(float(self.face_x(y, z)), y, z) for y, z in corners])
        return points, np.array([(0, 1, 2), (1, 3, 2)])


def run(monkeypatch, structure, name, overrides, windows):
    monkeypatch.setattr(cosim.build, "build_structure", lambda scenario: structure)
    with threadpool_limits(1):
        s = cosim.build.build(load_scenario(name, overrides))
        return s, [s.macro_step() for _ in range(windows)]


def test_it_breaks_the_sheet_and_turns_the_loads_of_all_phases_to_its_own_side(monkeypatch):
    """Without friction sheet and blocks press along the normal: Fy / Fx = n_y / n_x = -tan beta, at every instant."""
    smooth = ["contact.friction=0", "rubble.friction_structure=0"]
    s, frames = run(monkeypatch, ObliqueSlope(), "upward_plane", smooth, 600)
    assert s.fragments > 0
    load = np.array([f.load for f in frames])
    for phase in (Phase.BREAKING, Phase.ROTATING):
        fx, fy = load[:, phase, 0], load[:, phase, 1]
        assert fx.max() > 1e3
        np.testing.assert_allclose(fy, -np.tan(BETA) * fx, atol=1e-6 * fx.max())
    assert s.ledger.mass_error < 1e-14
    assert s.ledger.energy.relative < 1e-2


FLOE, QUICK = "van_vliet_2018_floe_55m_centre", ("sheet.nodes=[20, 20]", "drift.velocity='0.4 m/s'")


def flat_sided(sides):
    c = load_scenario(FLOE, QUICK).structure
    return multi_sided_cone(
        sides, c.slope, c.waterline_radius, c.neck_radius, top=c.top, toe_depth=c.toe_depth, breaking=c.breaking
    )


def test_a_cone_with_many_flat_sides_is_the_round_one(monkeypatch):
    _, frames = run(monkeypatch, flat_sided(96), FLOE, QUICK, 20)
    monkeypatch.undo()
    with threadpool_limits(1):
        known = cosim.build.build(load_scenario(FLOE, QUICK))
    load = np.array([f.load.sum(axis=0) for f in frames])
    reference = np.array([known.macro_step().load.sum(axis=0) for _ in range(20)])
    assert reference[:, 0].max() > 1e4
    assert np.abs(load - reference).max() < 0.01 * reference[:, 0].max()


def test_a_cone_with_six_sides_breaks_a_floe_with_its_facet(monkeypatch):
    """It meets the straight edge with a whole side at once; pieces become blocks that press on the facets."""
    s, frames = run(monkeypatch, flat_sided(6), FLOE, (*QUICK, "contact.strength='800 kPa'"), 160)
    load = np.array([f.load for f in frames])
    assert load[0, Phase.BREAKING, 0] > 1e5
    assert s.fragments > 0
    assert load[:, Phase.ROTATING].any()
    assert s.ledger.mass_error < 1e-14
