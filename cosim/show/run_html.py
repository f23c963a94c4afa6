"""How a run shows itself in a notebook: title, peaks, what speaks against them, curves."""

from __future__ import annotations

import jinja2

from cosim.analysis.lights import trust, trust_lines
from cosim.analysis.run_data import RunData
from cosim.analysis.summary import summary
from cosim.show.cells import over_text
from cosim.show.curves import draw_curves
from cosim.show.png import embedded
from cosim.show.scale import scale_of, seconds
from coupling.interface import PHASES

COMPONENTS = ("fx", "fz", "f")
PAGE = """<div style="max-width: 60rem">
<p><b>{{ title }}</b><br>{{ simulated }} s, {{ windows }} windows, {{ events }} events; version {{ version }}</p>
{% if remark %}<p><b>Not a whole run:</b> {{ remark }}</p>{% endif %}
<table><tr><th style="text-align: left">peaks, means over {{ over }}</th>
{% for name in ("Fx", "Fz", "F") %}<th>{{ name }} [{{ loads.unit }}]</th><th>at [s]</th>{% endfor %}</tr>
{% for name, row in rows %}<tr><td style="text-align: left">{{ name }}</td>
{% for key in components %}
<td>{{ loads.text(row[key].value) }}</td><td>{{ times.text(row[key].time) }}</td>{% endfor %}</tr>
{% endfor %}</table>
<p>{% for line in trust %}{{ line }}{% if not loop.last %}<br>{% endif %}{% endfor %}</p>
<img alt="Fx and Fz over time by phase" style="max-width: 100%" src="data:image/png;base64,{{ png }}">
</div>"""


def run_html(run: RunData) -> str:
    """A piece of a page; texts of the recording are shown, never obeyed."""
    found = summary(run)
    rows = [("total", found["peaks"]), *((phase, found["peaks_by_phase"][phase]) for phase in PHASES)]
    cells = [row[key] for _, row in rows for key in COMPONENTS]
    page = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined).from_string(PAGE)
    return page.render(
        title=run.metadata["title"],
        version=run.metadata["version"],
        simulated=f"{run.t[-1]:g}",
        windows=len(run.t),
        events=len(run.events),
        remark=run.remark,
        over=over_text(run.averaging),
        loads=scale_of((cell["value"] for cell in cells), "N"),
        times=seconds(cell["time"] for cell in cells),
        rows=rows,
        components=COMPONENTS,
        trust=trust_lines(trust(run)),
        png=embedded(draw_curves, run),
    )
