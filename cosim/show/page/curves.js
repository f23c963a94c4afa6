"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const look = { breaking: ["#0072b2", 1.2, []], rotating: ["#e69f00", 1.2, [6, 3]], sliding: ["#009e73", 1.2, [2, 2]], total: ["#1d2733", 1.8, []] };
  const canvases = [...document.querySelectorAll("canvas[data-axis]")];
  const all = [0, data.t.length ? data.t[data.t.length - 1] : 1];
  let view = all, drag = null;
  const pad = { l: 62, r: 12, t: 22, b: 30 };
  const step = (span, most) => {
    const raw = span / most, ten = 10 ** Math.floor(Math.log10(raw));
    return [1, 2, 5, 10].map((k) => k * ten).find((s) => s >= raw);
  };
  const draw = (canvas) => {
    const axis = canvas.dataset.axis, ratio = window.devicePixelRatio || 1;
    const w = canvas.clientWidth, h = canvas.clientHeight, g = canvas.getContext("2d");
    canvas.width = w * ratio; canvas.height = h * ratio; g.scale(ratio, ratio);
    g.font = "12px system-ui, sans-serif"; g.fillStyle = "#51606f"; g.lineWidth = 1;
    let from = data.t.findIndex((t) => t >= view[0]), to = data.t.findLastIndex((t) => t <= view[1]) + 1;
    from = Math.max(from - 1, 0); to = Math.min(to + 1, data.t.length);
    let low = 0, high = 0;
    for (const name in look) for (let k = from; k < to; k++) { const v = data.series[axis][name][k]; low = Math.min(low, v); high = Math.max(high, v); }
    const room = (high - low || 1) * 0.05; low -= low < 0 ? room : 0; high += room;
    const x = (t) => pad.l + (t - view[0]) / (view[1] - view[0]) * (w - pad.l - pad.r);
    const y = (v) => h - pad.b - (v - low) / (high - low) * (h - pad.t - pad.b);
    g.textAlign = "right"; g.textBaseline = "middle"; g.strokeStyle = "#d5dce4";
    const dy = step(high - low, 6), dx = step(view[1] - view[0], 10);
    for (let v = Math.ceil(low / dy) * dy; v <= high; v += dy) { g.beginPath(); g.moveTo(pad.l, y(v)); g.lineTo(w - pad.r, y(v)); g.stroke(); g.fillText(+v.toPrecision(6), pad.l - 6, y(v)); }
    g.textAlign = "center"; g.textBaseline = "top";
    for (let t = Math.ceil(view[0] / dx) * dx; t <= view[1]; t += dx) { g.beginPath(); g.moveTo(x(t), pad.t); g.lineTo(x(t), h - pad.b); g.stroke(); g.fillText(+t.toPrecision(6), x(t), h - pad.b + 5); }
    g.textAlign = "left"; g.textBaseline = "alphabetic"; g.fillStyle = "#1d2733";
    g.fillText((axis === "fx" ? "Fx [" : "Fz [") + data.unit + "]", 4, 14);
    let place = pad.l + 60;
    for (const name of ["total", "breaking", "rotating", "sliding"]) { g.strokeStyle = look[name][0]; g.lineWidth = 2; g.setLineDash(look[name][2]); g.beginPath(); g.moveTo(place, 10); g.lineTo(place + 22, 10); g.stroke(); g.fillText(name, place + 27, 14); place += 105; }
    g.textAlign = "right"; g.fillText("time [s]", w - pad.r, h - 4);
    g.save(); g.beginPath(); g.rect(pad.l, pad.t, w - pad.l - pad.r, h - pad.t - pad.b); g.clip();
    for (const e of data.events) { g.strokeStyle = e.kind === "split" ? "#d55e00" : "#51606f"; g.lineWidth = 0.8; g.setLineDash(e.kind === "split" ? [] : [4, 3]); g.beginPath(); g.moveTo(x(e.t), pad.t); g.lineTo(x(e.t), h - pad.b); g.stroke(); }
    for (const name in look) {
      [g.strokeStyle, g.lineWidth] = look[name]; g.setLineDash(look[name][2]); g.beginPath();
      for (let k = from; k < to; k++) g[k > from ? "lineTo" : "moveTo"](x(data.t[k]), y(data.series[axis][name][k]));
      g.stroke();
    }
    if (drag) { g.fillStyle = "rgba(0, 114, 178, .15)"; g.fillRect(x(drag[0]), pad.t, x(drag[1]) - x(drag[0]), h - pad.t - pad.b); }
    g.restore();
  };
  const render = () => canvases.forEach(draw);
  const time = (canvas, event) => view[0] + (event.offsetX - pad.l) / (canvas.clientWidth - pad.l - pad.r) * (view[1] - view[0]);
  for (const canvas of canvases) {
    canvas.addEventListener("pointerdown", (e) => { canvas.setPointerCapture(e.pointerId); const t = time(canvas, e); drag = [t, t]; });
    canvas.addEventListener("pointermove", (e) => { if (drag) { drag[1] = time(canvas, e); render(); } });
    canvas.addEventListener("pointerup", () => {
      if (!drag) return;
      const [a, b] = drag[0] < drag[1] ? drag : [drag[1], drag[0]];
      drag = null;
      if (b - a > 0.002 * (view[1] - view[0])) view = [Math.max(a, all[0]), Math.min(b, all[1])];
      render();
    });
    canvas.addEventListener("dblclick", () => { view = all; render(); });
  }
  document.body.classList.add("live");
  window.addEventListener("resize", render);
  render();
})();
