// SPDX-License-Identifier: BSD-3-Clause
// Words over the scene, none upon another.

const words = (o) => {
  let text = `${CLASSES[o.cls]} ${o.id}`;
  if (o.moving && o.speed !== null) text += `, ${o.speed.toFixed(1)} m/s`;
  return o.seen ? text : text + ", hidden";
};

class Labels {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
  }

  /** @param obstacles  nearest to the camera wins where two labels would overlap; the picked one always. */
  draw(view, camera, obstacles, picked, wanted) {
    const c = this.context, dots = window.devicePixelRatio || 1;
    const width = this.canvas.width / dots, height = this.canvas.height / dots;
    c.setTransform(dots, 0, 0, dots, 0, 0);
    c.clearRect(0, 0, width, height);
    const style = getComputedStyle(document.documentElement), color = (name) => style.getPropertyValue("--" + name);
    c.font = "12.5px system-ui, 'DejaVu Sans', sans-serif";
    c.textAlign = "center";
    c.textBaseline = "bottom";
    const taken = [];
    const put = (text, p, ink, must) => {
      const w = c.measureText(text).width / 2 + 4, box = [p.x - w, p.y - 18, p.x + w, p.y];
      if (!must && taken.some((t) => box[0] < t[2] && box[2] > t[0] && box[1] < t[3] && box[3] > t[1])) return;
      taken.push(box);
      c.globalAlpha = 0.72;
      c.fillStyle = color("scene");
      c.fillRect(box[0], box[1] + 1, box[2] - box[0], 16);
      c.globalAlpha = 1;
      c.fillStyle = ink;
      c.fillText(text, p.x, p.y - 2);
    };
    const list = obstacles.filter((o) => o.id === picked || (wanted && view.layers.boxes && o.cls !== STRUCTURE))
      .map((o) => ({ o, p: project(camera, [o.x, o.y, o.z + o.height / 2], width, height) })).filter(({ p }) => p !== null)
      .sort((a, b) => (b.o.id === picked) - (a.o.id === picked) || a.p.depth - b.p.depth);
    for (const { o, p } of list) put(words(o), p, color(CLASSES[o.cls]), o.id === picked);
    if (!wanted) return;
    for (let r = 10; r <= 60; r += 10) {
      const p = project(camera, [r, 0, view.groundZ ?? 0], width, height);
      if (p) put(`${r} m`, p, color("dim"), false);
    }
  }
}
