// SPDX-License-Identifier: BSD-3-Clause
// Wires it all: what is shown, the keys and the mouse, and the clock.

const kTail = 3; // seconds

class Replay {
  constructor() {
    this.recording = new Recording();
    this.place = 0;       // of the scan that is wanted
    this.drawn = -1;      // of the scan that is shown
    this.picked = null;
    this.playing = false;
    this.following = false;
    this.clock = 0;       // recording time that playing has come to
    this.frames = 0;      // pictures drawn so far
    this.ready = false;
    this.dirty = true;
  }

  async open() {
    if (typeof DecompressionStream === "undefined") throw new Error("This browser is too old for this page: it needs one of 2023 or later.");
    await this.recording.open();
    this.view = new View(by("scene"));
    this.view.step = this.recording.meta.step;
    this.labels = new Labels(by("labels"));
    this.panel = new Panel((id) => this.pick(id));
    this.plots = new Plots(by("plots"), (time) => this.seekTime(time));
    this.setTheme(matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark");
    this.describe();
    this.addLayers();
    this.listen();
    this.fit();
    const hash = new URLSearchParams(location.hash.slice(1));
    if (this.recording.frames.length === 0) {
      by("message").textContent = "There is no scan in this recording.";
      this.ready = true;
      return;
    }
    if (hash.has("scan")) this.seek(this.placeOf(Number(hash.get("scan"))));
    else this.seek(0);
    if (hash.has("id")) this.pick(Number(hash.get("id")));
    await this.recording.ask(this.place);
    requestAnimationFrame((now) => this.tick(now));
    this.ready = true;
  }

  /** What the file is, and what was left out of it. */
  describe() {
    const { meta, frames } = this.recording, name = meta.input.split("/").pop();
    document.title = `${name} – replay`;
    by("title").textContent = name;
    by("subtitle").textContent = `${meta.scans} scans, ${meta.program}`;
    by("slider").max = Math.max(0, frames.length - 1);
    const notes = [meta.note];
    if (meta.every > 1) notes.push(`One scan of ${meta.every} is shown.`);
    const returns = frames.reduce((sum, frame) => sum + frame.returns, 0);
    const share = returns > 0 ? meta.points / returns : 1;
    notes.push(share < 0.999
      ? `Thinned to fit: ${Math.round(100 * share)} % of the returns are shown, those of road users first, in steps of ${100 * meta.step} cm.`
      : `All returns, in steps of ${100 * meta.step} cm.`);
    by("note").textContent = notes.filter((note) => note).join(" ");
    by("legend").innerHTML = ["vehicle", "pedestrian", "cyclist", "unknown", "structure", "ground"]
      .map((kind) => `<span><i style="background:var(--${kind})"></i>${kind}</span>`).join("") +
      `<span><i style="background:var(--speed)"></i>way in 1 s</span>`;
  }

  addLayers() {
    for (const name of Object.keys(this.view.layers)) {
      const button = document.createElement("button");
      button.textContent = name;
      button.setAttribute("aria-pressed", "true");
      button.addEventListener("click", () => {
        this.view.layers[name] = !this.view.layers[name];
        button.setAttribute("aria-pressed", String(this.view.layers[name]));
        this.refresh();
      });
      by("layers").append(button);
    }
  }

  setTheme(name) {
    document.documentElement.dataset.theme = name;
    by("theme").textContent = name === "dark" ? "light" : "dark";
    this.view.readColors();
    this.refresh();
  }
  toggleTheme() { this.setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"); }

  /** The scan with this number, or the nearest one that is here. */
  placeOf(index) {
    const { frames } = this.recording;
    let best = 0;
    for (const frame of frames) if (Math.abs(frame.index - index) < Math.abs(frames[best].index - index)) best = frame.place;
    return best;
  }

  seek(place) {
    const { frames } = this.recording;
    this.place = Math.min(frames.length - 1, Math.max(0, place));
    this.clock = frames[this.place].time;
    this.refresh();
  }
  seekTime(time) {
    const { frames } = this.recording;
    let place = 0;
    while (place + 1 < frames.length && frames[place + 1].time <= time + 1e-6) place++;
    this.seek(place);
  }

  play(on) {
    const { frames } = this.recording;
    if (on && this.place >= frames.length - 1) this.seek(0);
    this.playing = on && frames.length > 1;
    by("play").textContent = this.playing ? "pause" : "play";
    this.dirty = true;
  }

  pick(id) {
    this.picked = id;
    if (id === null) this.following = false;
    this.refresh();
  }
  refresh() {
    this.drawn = -1;
    this.dirty = true;
  }

  tick(now) {
    requestAnimationFrame((next) => this.tick(next));
    const passed = Math.min(0.25, (now - (this.lastTick ?? now)) / 1000);
    this.lastTick = now;
    if (this.playing) this.advance(passed * Number(by("speed").value));
    const isDue = this.dirty || this.drawn !== this.place;
    if (isDue) {
      this.pace(passed);
      this.draw();
    } else if (this.view.share < 1) {
      this.view.share = 1;
      this.view.draw();
    }
    this.drewLast = isDue;
  }

  /** Where a slow computer has to draw without a pause, it draws fewer points of the background; all once it rests. */
  pace(passed) {
    if (!this.drewLast) return;
    const kSlow = 0.031, kFast = 0.02;
    this.pause = 0.7 * (this.pause ?? passed) + 0.3 * passed;
    if (this.pause > kSlow) this.view.share = Math.max(0.2, 0.85 * this.view.share);
    else if (this.pause < kFast) this.view.share = Math.min(1, 1.1 * this.view.share);
  }

  /** Moves the clock, but not past a scan that is still to be unpacked. */
  advance(seconds) {
    const { frames } = this.recording;
    const wanted = this.clock + seconds;
    while (this.place + 1 < frames.length && frames[this.place + 1].time <= wanted) {
      if (!this.recording.scanAt(this.place + 1)) return;
      this.place++;
      this.clock = frames[this.place].time;
    }
    this.clock = wanted;
    for (let k = 1; k <= 6; k++) this.recording.ask(this.place + k);
    if (this.place === frames.length - 1) this.play(false);
  }

  draw() {
    if (this.drawn !== this.place) this.show();
    const camera = this.view.draw();
    this.labels.draw(this.view, camera, this.obstacles ?? [], this.picked, this.view.layers.labels);
    this.dirty = this.drawn !== this.place;
    this.frames++;
  }

  /** Hands the wanted scan to the view, if it is unpacked. */
  show() {
    const scan = this.recording.scanAt(this.place), frame = this.recording.frames[this.place];
    if (!scan) return;
    this.obstacles = [...frame.obstacles, ...scan.structure];
    const picked = this.obstacles.find((o) => o.id === this.picked) ?? null;
    if (this.following && picked) this.view.camera.target = [picked.x, picked.y, picked.z];
    this.view.setScan(scan);
    this.view.setObjects(this.obstacles, this.tailsOf(frame), this.picked);
    this.panel.list(frame.obstacles, this.picked);
    this.panel.details(this.picked, picked, this.following);
    const history = this.recording.tracks.get(this.picked);
    by("plots").hidden = !history;
    if (history) this.plots.draw(history, this.recording.start, frame.time);
    this.showTime(frame);
    this.drawn = this.place;
  }

  /** Where the tracks of a scan were in the seconds before, seen from the vehicle now. */
  tailsOf(frame) {
    const tails = [];
    for (const o of frame.obstacles) {
      const history = this.recording.tracks.get(o.id);
      if (!history) continue;
      const places = [];
      for (const h of history) {
        if (h.place > frame.place || h.time < frame.time - kTail) continue;
        const then = this.recording.frames[h.place].pose, at = [h.o.x, h.o.y, h.o.z];
        if (then && frame.pose) places.push(toVehicle(frame.pose, toWorld(then, at)));
        else if (!then && !frame.pose) places.push(at);
      }
      tails.push({ rgb: this.view.colors[CLASSES[o.cls]], places });
    }
    return tails;
  }

  showTime(frame) {
    const { frames, start } = this.recording, utc = new Date(frame.time * 1000).toISOString().replace("T", " ").replace("Z", "");
    by("time").innerHTML = `<b>${(frame.time - start).toFixed(1)} s</b> <span>of ${(frames[frames.length - 1].time - start).toFixed(1)} s &nbsp; ` +
      `scan ${frame.index} &nbsp; ${utc} UTC &nbsp; ${frame.returns} returns</span>`;
    by("slider").value = frame.place;
    by("slider").setAttribute("aria-valuetext", `scan ${frame.index}, ${(frame.time - start).toFixed(1)} s`);
    this.drawBars(frame);
  }

  /** Road users by scan, above the slider. */
  drawBars(now) {
    const canvas = by("bars"), c = canvas.getContext("2d"), { frames } = this.recording;
    const dots = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    const style = getComputedStyle(document.documentElement), kThumb = 8; // half the slider's knob
    const key = `${width} ${dots} ${document.documentElement.dataset.theme}`;
    if (this.barsKey !== key) {
      canvas.width = width * dots;
      canvas.height = height * dots;
      this.bars = this.barsOf(width, height, dots, kThumb, style);
      this.barsKey = key;
    }
    const x = kThumb + (frames.length > 1 ? now.place * (width - 2 * kThumb) / (frames.length - 1) : 0);
    c.setTransform(dots, 0, 0, dots, 0, 0);
    c.clearRect(0, 0, width, height);
    c.drawImage(this.bars, 0, 0, width, height);
    c.globalAlpha = 0.55; // what is still to come
    c.fillStyle = style.getPropertyValue("--panel");
    c.fillRect(x, 0, width, height);
    c.globalAlpha = 1;
    c.fillStyle = style.getPropertyValue("--text");
    c.fillRect(x - 0.75, 0, 1.5, height);
  }

  barsOf(width, height, dots, margin, style) {
    const { frames } = this.recording, order = [1, 2, 3], canvas = document.createElement("canvas");
    canvas.width = Math.max(1, width * dots);
    canvas.height = Math.max(1, height * dots);
    const c = canvas.getContext("2d");
    c.scale(dots, dots);
    const counts = frames.map((frame) => order.map((cls) => frame.obstacles.filter((o) => o.cls === cls).length));
    const most = Math.max(1, ...counts.map((list) => list.reduce((sum, n) => sum + n, 0)));
    const wide = (width - 2 * margin) / Math.max(1, frames.length - 1);
    counts.forEach((list, place) => {
      let y = height;
      list.forEach((n, k) => {
        const tall = n / most * (height - 4);
        c.fillStyle = style.getPropertyValue("--" + CLASSES[order[k]]);
        c.fillRect(margin + (place - 0.5) * wide, y - tall, Math.max(0.6, wide * 0.9), tall);
        y -= tall;
      });
    });
    return canvas;
  }

  fit() {
    const dots = window.devicePixelRatio || 1;
    for (const canvas of [by("scene"), by("labels")]) {
      canvas.width = Math.max(1, Math.round(canvas.clientWidth * dots));
      canvas.height = Math.max(1, Math.round(canvas.clientHeight * dots));
    }
    this.refresh();
  }

  /** The obstacle under a place of the window; null: none. Road users win over the structure around them. */
  under(clientX, clientY) {
    const { left, top, width, height } = by("scene").getBoundingClientRect();
    const ray = this.view.camera.ray(2 * (clientX - left) / width - 1, 1 - 2 * (clientY - top) / height, width / height);
    let best = null, nearest = Infinity;
    for (const o of this.obstacles ?? []) {
      const isStructure = o.cls === STRUCTURE;
      if (!(isStructure ? this.view.layers.structure : this.view.layers.boxes)) continue;
      const hit = hitBox(ray, o, isStructure ? 0 : 0.15) + (isStructure ? 3 : 0);
      if (hit < nearest) [best, nearest] = [o, hit];
    }
    return best;
  }

  listen() {
    new ResizeObserver(() => this.fit()).observe(by("stage"));
    const seekBy = (step) => { this.play(false); this.seek(this.place + step); };
    const last = () => this.recording.frames.length;
    for (const [id, run] of [["play", () => this.play(!this.playing)], ["first", () => seekBy(-last())], ["last", () => seekBy(last())],
      ["back", () => seekBy(-1)], ["next", () => seekBy(1)], ["theme", () => this.toggleTheme()], ["close", () => this.pick(null)],
      ["follow", () => this.toggleFollow()], ["view-behind", () => this.look("behind")], ["view-top", () => this.look("top")],
      ["help-button", () => this.toggleHelp()]]) by(id).addEventListener("click", run);
    by("slider").addEventListener("input", () => { this.play(false); this.seek(Number(by("slider").value)); });
    by("coloring").addEventListener("change", () => { this.view.coloring = Number(by("coloring").value); this.dirty = true; });
    addEventListener("keydown", (e) => this.onKey(e, seekBy));
    this.listenToMouse(by("scene"));
  }

  onKey(e, seekBy) {
    if (e.ctrlKey || e.altKey || e.metaKey || ["SELECT", "INPUT"].includes(e.target.tagName) && e.key !== " " && e.key !== "Escape") return;
    const step = e.shiftKey ? 10 : 1, keys = {
      " ": () => this.play(!this.playing), ArrowLeft: () => seekBy(-step), ArrowRight: () => seekBy(step), Home: () => seekBy(-1e9),
      End: () => seekBy(1e9), Escape: () => this.pick(null), t: () => this.toggleTheme(), f: () => this.toggleFollow(),
      1: () => this.look("behind"), 2: () => this.look("top"), h: () => this.toggleHelp(), "?": () => this.toggleHelp(),
    };
    if (!keys[e.key]) return;
    e.preventDefault();
    keys[e.key]();
  }

  toggleHelp() { by("help").hidden = !by("help").hidden; }
  toggleFollow() { if (this.picked !== null) { this.following = !this.following; this.refresh(); } }
  look(from) {
    this.following = false;
    this.view.camera[from]();
    this.refresh();
  }

  listenToMouse(canvas) {
    const pointers = new Map();
    let moved = 0;
    canvas.addEventListener("contextmenu", (e) => e.preventDefault());
    canvas.addEventListener("pointerdown", (e) => {
      canvas.setPointerCapture(e.pointerId);
      pointers.set(e.pointerId, { x: e.clientX, y: e.clientY });
      if (pointers.size === 1) moved = 0;
    });
    canvas.addEventListener("pointermove", (e) => {
      const before = pointers.get(e.pointerId);
      if (!before) { canvas.classList.toggle("over", this.under(e.clientX, e.clientY) !== null); return; }
      const dx = e.clientX - before.x, dy = e.clientY - before.y, camera = this.view.camera;
      moved += Math.abs(dx) + Math.abs(dy);
      if (pointers.size > 1) {
        const [other] = [...pointers].filter(([id]) => id !== e.pointerId).map(([, p]) => p);
        const far = (p) => Math.hypot(p.x - other.x, p.y - other.y) || 1;
        camera.zoom(far(before) / far({ x: e.clientX, y: e.clientY }));
        camera.move(dx / 2, dy / 2, canvas.clientHeight);
      } else if (e.buttons & 2 || e.shiftKey) camera.move(dx, dy, canvas.clientHeight);
      else camera.turn(dx, dy);
      pointers.set(e.pointerId, { x: e.clientX, y: e.clientY });
      this.dirty = true;
    });
    const up = (e) => {
      const wasClick = pointers.delete(e.pointerId) && pointers.size === 0 && moved < 5 && e.type === "pointerup" && e.button === 0;
      if (wasClick) this.pick(this.under(e.clientX, e.clientY)?.id ?? null);
    };
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", up);
    canvas.addEventListener("wheel", (e) => {
      e.preventDefault();
      this.view.camera.zoom(Math.exp(Math.sign(e.deltaY) * Math.min(60, Math.abs(e.deltaY)) * 0.002));
      this.dirty = true;
    }, { passive: false });
  }
}

const replay = window.replay = new Replay();
replay.open().catch((error) => {
  by("message").textContent = error.message;
  replay.failed = String(error.stack ?? error);
});
