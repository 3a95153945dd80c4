// SPDX-License-Identifier: BSD-3-Clause
// What the page holds: rows of obstacles of all scans, and scans that are unpacked when they are shown.

const CLASSES = ["unknown", "vehicle", "pedestrian", "cyclist", "structure"];
const KINDS = ["none", "ground", "unknown", "vehicle", "pedestrian", "cyclist", "structure"];
const STRUCTURE = 4;

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** Unpacks what zlib packed. */
async function inflate(base64) {
  const stream = new Blob([bytesOf(base64)]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** One obstacle from its row of whole numbers; metres and radians. */
function obstacleOf(row) {
  const [id, cls, x, y, z, length, width, height, yaw, flags, points, rings, distance] = row;
  const o = {
    id, cls, x: x / 100, y: y / 100, z: z / 100, length: length / 100, width: width / 100, height: height / 100,
    yaw: yaw / 1000, headingValid: (flags & 1) !== 0, seen: (flags & 2) !== 0, moving: (flags & 4) !== 0,
    directionKnown: (flags & 8) !== 0, velocityKnown: (flags & 16) !== 0, isTrack: (flags & 32) !== 0,
    points, rings, distance: distance / 100, vx: 0, vy: 0, speed: null, age: 0, probability: null,
  };
  if (row.length > 13) {
    const [vx, vy, , , age, ...probability] = row.slice(13);
    Object.assign(o, { vx: vx / 100, vy: vy / 100, age: age / 1000, speedStd: Math.hypot(row[15], row[16]) / 100 });
    if (o.velocityKnown) o.speed = Math.hypot(o.vx, o.vy);
    if (probability.some((p) => p > 0)) o.probability = probability.map((p) => p / 1000);
  }
  return o;
}

/** Runs of equal cells as one byte per cell. */
function gridOf(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const [x, y, z, size] = [0, 4, 8, 12].map((at) => view.getFloat32(at, true));
  const columns = view.getUint16(16, true), rows = view.getUint16(18, true);
  const states = new Uint8Array(columns * rows);
  for (let at = 20, cell = 0; at < bytes.length; at += 3) {
    const length = view.getUint16(at + 1, true);
    states.fill(bytes[at], cell, cell + length);
    cell += length;
  }
  return { x, y, z, size, columns, rows, states };
}

/**
 * Places as the graphics card wants them, three 16 bit steps each, kind by kind; and how many there are of each kind.
 * Those of one kind are shuffled: the first of them are spread over all.
 */
function pointsOf(bytes, count) {
  const counts = new Array(KINDS.length).fill(0), slots = new Uint32Array(count), begins = [], seen = [];
  for (let i = 0; i < count; i++) counts[bytes[i]]++;
  counts.reduce((first, n, kind) => { begins[kind] = first; seen[kind] = 0; return first + n; }, 0);
  const kPrime = 1000003; // larger than any count, so that each place is taken once
  for (let i = 0; i < count; i++) {
    const kind = bytes[i];
    slots[i] = 3 * (begins[kind] + (seen[kind]++ * kPrime) % counts[kind]);
  }
  const points = new Int16Array(3 * count);
  for (let axis = 0; axis < 3; axis++) {
    const low = count * (1 + 2 * axis), high = low + count;
    for (let i = 0, place = 0; i < count; i++) {
      place = (place + bytes[low + i] + 256 * bytes[high + i]) & 0xffff;
      points[slots[i] + axis] = place;
    }
  }
  return { points, counts };
}

class Recording {
  constructor() {
    this.meta = JSON.parse(document.getElementById("meta").textContent);
    this.lines = document.getElementById("scans").textContent.split("\n").filter((line) => line.length > 0);
    this.unpacked = new Map(); // in the order of use
    this.waiting = new Map();
    this.frames = [];
    this.tracks = new Map();
  }

  /** Reads the obstacles of all scans. */
  async open() {
    const rows = JSON.parse(new TextDecoder().decode(await inflate(document.getElementById("rows").textContent)));
    this.frames = rows.map(([index, time, pose, returns, list], place) => ({
      index, time, returns, place, pose: pose === 0 ? null : pose, obstacles: list.map(obstacleOf),
    }));
    for (const frame of this.frames) {
      for (const o of frame.obstacles) {
        if (!o.isTrack) continue;
        if (!this.tracks.has(o.id)) this.tracks.set(o.id, []);
        this.tracks.get(o.id).push({ place: frame.place, time: frame.time, o });
      }
    }
    this.start = this.frames.length ? this.frames[0].time : 0;
  }

  /** Points, grid and structure of a scan if they are at hand; asks for them otherwise. */
  scanAt(place) {
    const scan = this.unpacked.get(place);
    if (scan) {
      this.unpacked.delete(place);
      this.unpacked.set(place, scan);
      return scan;
    }
    this.ask(place);
    return null;
  }

  async ask(place) {
    if (place < 0 || place >= this.lines.length || this.unpacked.has(place)) return;
    if (!this.waiting.has(place)) this.waiting.set(place, this.unpack(place));
    await this.waiting.get(place);
  }

  async unpack(place) {
    const bytes = await inflate(this.lines[place]);
    const view = new DataView(bytes.buffer);
    let at = 0;
    const part = () => {
      const size = view.getUint32(at, true);
      at += 4 + size;
      return bytes.subarray(at - size, at);
    };
    const structure = JSON.parse(new TextDecoder().decode(part())).map(obstacleOf);
    const grid = gridOf(part());
    const count = view.getUint32(at, true);
    this.unpacked.set(place, { structure, grid, ...pointsOf(bytes.subarray(at + 4), count) });
    this.waiting.delete(place);
    const kMost = 60;
    while (this.unpacked.size > kMost) this.unpacked.delete(this.unpacked.keys().next().value);
  }
}
