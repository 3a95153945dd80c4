// SPDX-License-Identifier: BSD-3-Clause
// The history of a track as small plots over time.

const PLOTS = [
  { name: "speed", unit: "m/s", lines: [["", "speed", (o) => o.speed]] },
  { name: "distance", unit: "m", lines: [["", "accent", (o) => o.distance]] },
  { name: "size", unit: "m", lines: [["length", "length", (o) => o.length], ["width", "width", (o) => o.width], ["height", "height", (o) => o.height]] },
  { name: "class", unit: "", most: 1,
    lines: CLASSES.map((name, k) => [name, name, (o) => (o.probability ? o.probability[k] : null)]) },
];

/** A round number not below n. */
function roundUp(n) {
  const power = 10 ** Math.floor(Math.log10(n));
  return [1, 2, 2.5, 5, 10].map((k) => k * power).find((step) => step >= n - 1e-9);
}

class Plots {
  /** @param seek  called with a time [s]. */
  constructor(parent, seek) {
    this.seek = seek;
    this.items = PLOTS.map((plot) => {
      const figure = document.createElement("figure"), caption = document.createElement("figcaption");
      const canvas = document.createElement("canvas");
      figure.className = "plot";
      caption.innerHTML = `<b>${plot.name}</b>` + (plot.unit ? `<span>${plot.unit}</span>` : "") +
        plot.lines.filter(([name]) => name).map(([name, color]) => `<span style="color:var(--${color})">${name}</span>`).join("");
      figure.append(caption, canvas);
      parent.append(figure);
      canvas.addEventListener("pointerdown", (e) => {
        const { left, width } = canvas.getBoundingClientRect();
        this.seek(this.timeAt((e.clientX - left) / width * width));
      });
      return { plot, canvas };
    });
  }

  timeAt(x) {
    const share = (x - this.left) / (this.right - this.left);
    return this.from + Math.min(1, Math.max(0, share)) * (this.to - this.from);
  }

  /** @param history  of the track; start and now [s]. */
  draw(history, start, now) {
    this.from = history[0].time;
    this.to = Math.max(history[history.length - 1].time, this.from + 0.5);
    for (const item of this.items) this.drawOne(item, history, start, now);
  }

  drawOne({ plot, canvas }, history, start, now) {
    const dots = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    if (width === 0) return;
    canvas.width = width * dots;
    canvas.height = height * dots;
    const c = canvas.getContext("2d"), style = getComputedStyle(document.documentElement);
    const color = (name) => style.getPropertyValue("--" + name);
    c.scale(dots, dots);
    const left = this.left = 32, right = this.right = width - 6, top = 6, bottom = height - 16;
    let most = plot.most ?? 0;
    if (!plot.most) for (const [, , get] of plot.lines) for (const { o } of history) most = Math.max(most, get(o) ?? 0);
    most = plot.most ?? roundUp(Math.max(most * 1.05, 0.5));
    const x = (t) => left + (t - this.from) / (this.to - this.from) * (right - left);
    const y = (v) => bottom - v / most * (bottom - top);
    this.drawFrame(c, { left, right, top, bottom, most, x, y, start, color });
    c.lineWidth = 1.6;
    c.lineJoin = "round";
    for (const [, ink, get] of plot.lines) {
      c.strokeStyle = color(ink);
      c.beginPath();
      let last = null;
      for (const h of history) {
        const value = get(h.o);
        if (value === null) { last = null; continue; }
        if (last === null || h.place > last + 3) c.moveTo(x(h.time) - 0.5, y(value));
        c.lineTo(x(h.time), y(value));
        last = h.place;
      }
      c.stroke();
    }
    if (now < this.from || now > this.to) return;
    c.fillStyle = color("text");
    c.fillRect(x(now) - 0.5, top, 1, bottom - top);
    for (const [, ink, get] of plot.lines) {
      const here = history.find((h) => Math.abs(h.time - now) < 1e-3), value = here ? get(here.o) : null;
      if (value === null) continue;
      c.fillStyle = color(ink);
      c.beginPath();
      c.arc(x(now), y(value), 3, 0, 7);
      c.fill();
    }
  }

  drawFrame(c, f) {
    c.strokeStyle = f.color("line");
    c.fillStyle = f.color("dim");
    c.font = "11px system-ui, 'DejaVu Sans', sans-serif";
    c.lineWidth = 1;
    c.textAlign = "right";
    c.textBaseline = "middle";
    for (const share of [0, 0.5, 1]) {
      const at = Math.round(f.y(share * f.most)) + 0.5;
      c.beginPath();
      c.moveTo(f.left, at);
      c.lineTo(f.right, at);
      c.stroke();
      c.fillText(String(Math.round(share * f.most * 100) / 100), f.left - 5, at);
    }
    c.textBaseline = "alphabetic";
    c.textAlign = "left";
    c.fillText(`${(this.from - f.start).toFixed(1)} s`, f.left, f.bottom + 13);
    c.textAlign = "right";
    c.fillText(`${(this.to - f.start).toFixed(1)} s`, f.right, f.bottom + 13);
  }
}
