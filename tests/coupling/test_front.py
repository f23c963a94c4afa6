"""The front of the sheet behind its first row: the ice leads its node by half a cell, and is met there."""

import numpy as np
import pytest

from coupling.contact import ContactLaw
from coupling.crushing import CONTACTS
from coupling.interface import SheetForces
from coupling.sheet_port import SheetPort
from coupling.structure import plane_slope
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.implicit.engine import Engine
from lattice.sheet import Sheet
from lattice.stiffness import hrennikoff

D = 2.0
ICE = Ice(E=8.7e9, nu=1 / 3, h=1.0, rho_i=846.0, rho_w=1006.0, sigma_t=1e15, sigma_f=1e15, sigma_c=5e15)


def port(contact="overlap", rows_gone=0):
    grid = Grid.rectangle(20.0, 12.0, 11, 7, -20.0 - ICE.freeboard, -6.0)
    held = np.zeros(grid.nodes, bool)
    held[grid.edge_nodes("x-")] = True
    sheet = Sheet(Engine(grid, ICE, hrennikoff(ICE), held_in_plane=held), 0.05)
    law = ContactLaw(200e3, 0.1, ICE.E / D)
    out = SheetPort(sheet, plane_slope(np.pi / 4), law, 0.1, contact=CONTACTS[contact])
    for row in range(rows_gone):
        sheet.retire((10 - row) * 7 + np.arange(7))
        out.front.renew()
    return out


def tilted(p, angle, lift):
    """The whole sheet turned about y, as a rigid body: w = lift - angle x."""
    s = p.sheet.state
    s.q[:, 1] = angle
    s.q[:, 0] = lift - angle * p.sheet.grid.xy[:, 0]
    return p


@pytest.mark.parametrize("rows_gone", [0, 1, 3])
def test_the_overlap_is_that_of_the_true_front(rows_gone):
    """A rigid sheet that dips its front: where it meets the slope of 45 degrees is geometry."""
    p = tilted(port(rows_gone=rows_gone), 0.03, 0.2)
    front = p.sheet.grid.xy[:, 0].max() - (rows_gone * D - (D / 2 if rows_gone else 0.0))
    t = 60.0
    L, _ = p.contact.overlap(t, p.front.displacement())
    z = ICE.freeboard + 0.2 - 0.03 * front
    np.testing.assert_allclose(L, max(front + 0.1 * t + z, 0.0), rtol=1e-12)
    assert L.min() > 0.0


@pytest.mark.parametrize("contact", ["overlap", "crushing"])
def test_the_force_turns_the_node_by_its_lever(contact):
    """Work that the force does on a small turn of the nodes: F_z times the way of the front, z F_x for the height."""
    p = port(contact, rows_gone=2)
    c, state = p.contact, p.sheet.state
    force = c.evaluate(30.0, p.front.displacement())[0]
    before = p.front.displacement()
    state.q[:, 1] += 1e-3
    work = (force * (p.front.displacement() - before)).sum()
    assert c.lead == pytest.approx(D / 2)
    assert work == pytest.approx(1e-3 * (c.height * force[:, 0] - D / 2 * force[:, 2]).sum(), rel=1e-9)
    assert work > 0.0  # the slope presses the front down, which turns it that way


def test_the_contact_is_reported_node_by_node_where_it_acts():
    """The forces add up to minus the load; each acts at the front of its node's ice, at the height of the contact."""
    p = port("crushing", rows_gone=1)
    report = p.advance(12_000_000_000, 50_000_000, SheetForces.none(), np.zeros(3))
    c, s = report.contact, p.sheet.state
    np.testing.assert_allclose(c.force.sum(axis=0), -report.load, rtol=1e-12)
    assert report.load[0] > 0.0
    np.testing.assert_array_equal(c.nodes, 9 * 7 + np.arange(7))
    x, y = p.sheet.grid.xy[c.nodes].T.copy()
    height = 0.5 * ICE.h
    y[[0, -1]] += D / 4 * np.array([1.0, -1.0])  # ice of half a cell
    np.testing.assert_allclose(c.position[:, 1], y + s.u[c.nodes, 1] + height * s.q[c.nodes, 2], rtol=0, atol=1e-12)
    front = x + D / 2 + 0.1 * 12.05 + s.u[c.nodes, 0] + height * s.q[c.nodes, 1]
    np.testing.assert_allclose(c.position[:, 0], front, rtol=1e-12)
    z = ICE.freeboard + s.q[c.nodes, 0] - D / 2 * s.q[c.nodes, 1]
    np.testing.assert_allclose(c.position[:, 2], z, rtol=1e-9)


@pytest.mark.parametrize(("behind", "rows"), [(-np.inf, 6), (3.0, 6), (8.9, 6), (9.1, 11), (15.0, 11), (np.inf, 11)])
def test_the_sheet_is_known_as_far_back_as_rubble_reaches(behind, rows):
    """In steps of ten thicknesses, here 10 m or 5 cells, one thickness ahead of the rearmost block."""
    p = port()
    front = p.sheet.grid.xy[:, 0].max()
    edge = p.edges({2: front - behind})[2]
    assert len(edge.x) == rows
    assert edge.x[-1] <= max(front - behind, p.sheet.grid.xy[:, 0].min())
