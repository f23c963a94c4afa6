"""What happens to plates, as events of a run."""

from __future__ import annotations

from coupling.interface import Array, Event
from rubble.breaking import Break


def told(t_ns: int, load: Array, b: Break) -> Event:
    """A plate has broken again under the load (3,) [N]."""
    x, y, z = b.position.tolist()
    longer, area = max(b.lengths), sum(b.areas)
    text = f"piece of {area:.0f} m2 breaks again into {b.areas[0]:.0f} and {b.areas[1]:.0f} m2"
    fx, fy, fz = load.tolist()
    return Event(
        t_ns,
        "breaks_again",
        (fx, fy, fz),
        cells=0,
        position=(x, y, z),
        text=text,
        length=longer,
        area=area,
        cause="flexural-strength",
    )
