// SPDX-License-Identifier: BSD-3-Clause
// Words beside the scene: the list of obstacles and the numbers of the picked one.

const by = (id) => document.getElementById(id);
const fixed = (n, digits = 1) => (n === null || n === undefined ? "–" : n.toFixed(digits));

const COLUMNS = [
  ["class", (o) => CLASSES[o.cls]], ["id", (o) => o.id], ["distance", (o) => o.distance], ["speed", (o) => o.speed ?? -1],
  ["p", (o) => (o.probability ? o.probability[o.cls] : -1)],
];

class Panel {
  /** @param pick  called with the number of an obstacle. */
  constructor(pick) {
    this.pick = pick;
    this.order = { column: 2, falls: false };
    COLUMNS.forEach(([name], k) => {
      const head = document.createElement("th");
      head.textContent = name;
      head.title = name === "p" ? "probability of the class" : { distance: "m", speed: "m/s" }[name] ?? "";
      head.addEventListener("click", () => {
        this.order = { column: k, falls: this.order.column === k && !this.order.falls };
        this.list(this.shown, this.picked);
      });
      by("heads").append(head);
    });
  }

  list(obstacles, picked) {
    this.shown = obstacles;
    this.picked = picked;
    const [, key] = COLUMNS[this.order.column], sign = this.order.falls ? -1 : 1;
    const sorted = [...obstacles].sort((a, b) => sign * (key(a) > key(b) ? 1 : key(a) < key(b) ? -1 : a.id - b.id));
    by("count").textContent = `(${obstacles.length})`;
    [...by("heads").children].forEach((head, k) => {
      if (k === this.order.column) head.setAttribute("aria-sort", this.order.falls ? "descending" : "ascending");
      else head.removeAttribute("aria-sort");
    });
    by("obstacles").replaceChildren(...sorted.map((o) => {
      const row = document.createElement("tr");
      row.className = (o.id === picked ? "picked " : "") + (o.seen ? "" : "hidden");
      const p = o.probability ? `${Math.round(100 * o.probability[o.cls])} %` : "–";
      row.innerHTML = `<td><i style="background:var(--${CLASSES[o.cls]})"></i>${CLASSES[o.cls]}</td><td>${o.id}</td>` +
        `<td>${fixed(o.distance)} m</td><td>${o.speed === null ? "–" : fixed(o.moving ? o.speed : 0) + " m/s"}</td><td>${p}</td>`;
      row.addEventListener("click", () => this.pick(o.id));
      return row;
    }));
  }

  /** @param o  the obstacle in this scan; null where it is not there. */
  details(id, o, followed) {
    by("details").hidden = id === null;
    if (id === null) return;
    by("follow").setAttribute("aria-pressed", String(followed));
    by("picked-name").textContent = o ? `${CLASSES[o.cls]} ${id}` : `${id}`;
    const degrees = (rad) => `${Math.round(rad * 180 / Math.PI) || 0}°`;
    const rows = o ? [
      ["probability", o.probability ? `${Math.round(100 * o.probability[o.cls])} %` : "–"],
      ["distance", `${fixed(o.distance, 2)} m`],
      ["centre x, y, z", `${fixed(o.x, 2)}, ${fixed(o.y, 2)}, ${fixed(o.z, 2)} m`],
      ["length, width, height", `${fixed(o.length, 2)}, ${fixed(o.width, 2)}, ${fixed(o.height, 2)} m`],
      ["heading", o.headingValid ? degrees(o.yaw) + (o.directionKnown ? "" : " or opposite") : "not known"],
      ["speed", o.speed === null ? "not known" : o.moving ? `${fixed(o.speed, 2)} ± ${fixed(o.speedStd, 2)} m/s` : "stands"],
      ["returns, planes", `${o.points}, ${o.rings || "–"}`],
      ["seen", o.seen ? "in this scan" : "hidden, predicted"],
      ["age", o.isTrack ? `${fixed(o.age, 1)} s` : "–"],
    ] : [["", "not in this scan"]];
    by("numbers").innerHTML = rows.map(([name, value]) => `<dt>${name}</dt><dd>${value}</dd>`).join("");
  }
}
