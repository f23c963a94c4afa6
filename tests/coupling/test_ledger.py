"""The ledger: what it adds up, and the error at which a run stops."""

import pytest

from coupling.interface import HandOver, SimulationError
from coupling.ledger import Ledger


class NoBooks:
    """An energy balance of the whole system that is always closed."""

    floor, work = 1e5, 0.0

    def close(self, t_ns, sheet, rubble):
        return {}


def ledger():
    return Ledger(100.0, energy=NoBooks())


def close(book, *, sheet=90.0, crushed=1.0, rubble=7.0, cleared=2.0, energy=None):
    return book.close_window(1_000_000_000, sheet, crushed, rubble, cleared, energy or {}, {})


def test_a_new_ledger_has_no_error():
    book = ledger()
    for name in ("mass_error", "momentum_error", "angular_momentum_error"):
        assert getattr(book, name) == 0.0
    assert (book.trimmed_mass, book.handed_over_mass, book.sheet_energy_residual) == (0.0, 0.0, 0.0)


def test_mass_is_where_it_went():
    book = ledger()
    book.hand_over(0, HandOver(1, 5.0, 0.5, 0.0))
    book.crush(0.25)
    assert (book.trimmed_mass, book.handed_over_mass) == (0.75, 4.5)
    out = close(book, sheet=90.0, crushed=1.0, rubble=6.25, cleared=2.0)
    assert out["crushed_mass"] == 1.75
    assert out["mass_error"] == book.mass_error == 0.0


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_mass_that_comes_or_goes_stops_the_run(sign):
    book = ledger()
    close(book, rubble=7.0 + sign * 0.9e-10)
    assert book.mass_error == pytest.approx(0.9e-12, rel=0.02)
    close(book)
    assert book.mass_error == pytest.approx(0.9e-12, rel=0.02)  # the largest so far
    with pytest.raises(SimulationError, match=r"t = 1\.000 s: the balance of mass is off"):
        close(book, rubble=7.0 + sign * 1.1e-10)


@pytest.mark.parametrize("which", ["momentum_error", "angular_momentum_error"])
def test_momentum_lost_in_a_hand_over_stops_the_run(which):
    book = ledger()
    book.hand_over(0, HandOver(1, 5.0, 0.0, **{"momentum_error": 0.0, which: 0.9e-9}))
    book.hand_over(0, HandOver(1, 5.0, 0.0, 0.0))
    assert getattr(book, which) == 0.9e-9
    with pytest.raises(SimulationError, match="momentum of a hand-over"):
        book.hand_over(0, HandOver(1, 5.0, 0.0, **{"momentum_error": 0.0, which: 1.1e-9}))


def energy(residual, contact=0.0, rubble=0.0):
    return {"sheet_energy_residual": residual, "contact_work": contact, "rubble_work": rubble}


@pytest.mark.parametrize(
    "work", [{"contact": -5e4}, {"contact": 5e4}, {"rubble": -5e4}, {"rubble": 5e4, "contact": 1e4}]
)
def test_the_sheet_s_energy_is_measured_by_the_largest_work(work):
    book = ledger()
    close(book, energy=energy(49.0, **work))
    assert book.sheet_energy_residual == pytest.approx(49.0 / 5e4, rel=1e-12)
    close(book, energy=energy(-49.0))  # the largest so far
    assert book.sheet_energy_residual == pytest.approx(49.0 / 5e4, rel=1e-12)
    with pytest.raises(SimulationError, match="energy of the sheet"):
        close(book, energy=energy(-51.0, **work))


def test_what_the_sheet_pushes_along_counts_by_the_work_of_the_drift():
    """In the frame of the sheet it does no work, and the books of a floe that pushes ice along would not close."""
    book = ledger()
    with pytest.raises(SimulationError, match="energy of the sheet"):
        close(book, energy=energy(26.0, rubble=2.5e4))
    book.energy.work = 7e6
    close(book, energy=energy(26.0, rubble=2.5e4))
    assert book.sheet_energy_residual == pytest.approx(26.0 / 7e6, rel=1e-12)
    with pytest.raises(SimulationError, match="energy of the sheet"):
        close(book, energy=energy(7.1e3, rubble=2.5e4))


def test_what_the_sheet_runs_into_counts_by_the_kinetic_energy_that_it_takes():
    """4 J are missing where ice takes 10 kJ of the floe's motion, and 400 J of work in its frame."""
    book, kinetic = ledger(), NoBooks.floor - 1e4
    with pytest.raises(SimulationError, match="energy of the sheet"):
        close(ledger(), energy=energy(4.4, rubble=400.0))
    close(book, energy=energy(4.4, rubble=400.0) | {"sheet_kinetic": kinetic})
    assert book.sheet_energy_residual == pytest.approx(4.4e-4, rel=1e-12)
    with pytest.raises(SimulationError, match="energy of the sheet"):
        close(ledger(), energy=energy(11.0, rubble=400.0) | {"sheet_kinetic": kinetic})


def test_work_below_a_share_of_what_the_floe_brings_along_counts_as_that_share():
    book = ledger()
    close(book, energy=energy(9e-4))
    assert book.sheet_energy_residual == pytest.approx(9e-4, rel=1e-12)
