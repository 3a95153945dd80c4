// SPDX-License-Identifier: BSD-3-Clause
// Camera, boxes and rays. Matrices are column by column, as WebGL wants them.

const EDGES = [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];
const FACES = [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

function cornersOf(o) {
  const c = Math.cos(o.yaw), s = Math.sin(o.yaw);
  return [0, 1, 2, 3, 4, 5, 6, 7].map((k) => {
    const along = ((k % 4 === 1 || k % 4 === 2) ? 0.5 : -0.5) * o.length, across = (k % 4 > 1 ? 0.5 : -0.5) * o.width;
    return [o.x + c * along - s * across, o.y + s * along + c * across, o.z + (k > 3 ? 0.5 : -0.5) * o.height];
  });
}

const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => { const n = Math.hypot(...a) || 1; return a.map((v) => v / n); };

/** v turned by the quaternion q = [x, y, z, w]. */
function rotate(q, v) {
  const u = [q[0], q[1], q[2]], t = cross(u, v).map((n) => 2 * n), more = cross(u, t);
  return [0, 1, 2].map((k) => v[k] + q[3] * t[k] + more[k]);
}
const toWorld = (pose, v) => rotate(pose.slice(3), v).map((n, k) => n + pose[k]);
function toVehicle(pose, v) {
  const q = [-pose[3], -pose[4], -pose[5], pose[6]];
  return rotate(q, sub(v, pose));
}

class Camera {
  constructor() {
    this.fov = 0.8;
    this.behind();
  }
  behind() { Object.assign(this, { target: [12, 0, -1], distance: 42, azimuth: Math.PI, elevation: 0.5 }); }
  top() { Object.assign(this, { target: [8, 0, -1], distance: 75, azimuth: Math.PI, elevation: 1.5607 }); }

  eye() {
    const flat = this.distance * Math.cos(this.elevation);
    return [this.target[0] + flat * Math.cos(this.azimuth), this.target[1] + flat * Math.sin(this.azimuth),
      this.target[2] + this.distance * Math.sin(this.elevation)];
  }
  axes() {
    const forward = unit(sub(this.target, this.eye())), right = unit(cross(forward, [0, 0, 1]));
    return { forward, right, up: cross(right, forward) };
  }
  matrix(aspect) {
    const eye = this.eye(), { forward: f, right: r, up: u } = this.axes();
    const near = Math.max(0.2, this.distance / 100), far = this.distance + 400, s = 1 / Math.tan(this.fov / 2);
    const a = -(far + near) / (far - near), b = -2 * far * near / (far - near);
    const view = [r[0], u[0], -f[0], r[1], u[1], -f[1], r[2], u[2], -f[2], -dot(r, eye), -dot(u, eye), dot(f, eye)];
    const m = new Float32Array(16);
    for (let column = 0; column < 4; column++) {
      const [x, y, z] = view.slice(3 * column, 3 * column + 3);
      m.set([x * s / aspect, y * s, a * z + (column === 3 ? b : 0), -z], 4 * column);
    }
    return m;
  }
  /** Ray through a place of the picture, -1 to 1. */
  ray(x, y, aspect) {
    const { forward, right, up } = this.axes(), t = Math.tan(this.fov / 2);
    return { from: this.eye(), along: unit([0, 1, 2].map((k) => forward[k] + x * t * aspect * right[k] + y * t * up[k])) };
  }
  turn(dx, dy) {
    this.azimuth -= dx * 0.006;
    this.elevation = Math.min(1.5607, Math.max(0.02, this.elevation + dy * 0.006));
  }
  move(dx, dy, height) {
    const { right } = this.axes(), ahead = unit([-Math.cos(this.azimuth), -Math.sin(this.azimuth), 0]);
    const scale = 2 * this.distance * Math.tan(this.fov / 2) / height;
    for (let k = 0; k < 2; k++) this.target[k] += scale * (-dx * right[k] + dy * ahead[k]);
  }
  zoom(factor) { this.distance = Math.min(400, Math.max(2, this.distance * factor)); }
}

/** Where a place is in the picture [pixels], and its depth; null behind the camera. */
function project(m, p, width, height) {
  const at = (row) => m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row];
  const w = at(3);
  return w <= 0.1 ? null : { x: (at(0) / w + 1) * width / 2, y: (1 - at(1) / w) * height / 2, depth: w };
}

/** How far along the ray the box is hit; Infinity: not at all. A little margin makes small boxes easy to hit. */
function hitBox(ray, o, margin) {
  const c = Math.cos(o.yaw), s = Math.sin(o.yaw), d = sub(ray.from, [o.x, o.y, o.z]);
  const from = [c * d[0] + s * d[1], -s * d[0] + c * d[1], d[2]];
  const along = [c * ray.along[0] + s * ray.along[1], -s * ray.along[0] + c * ray.along[1], ray.along[2]];
  const half = [o.length, o.width, o.height].map((size) => size / 2 + margin);
  let near = 0, far = Infinity;
  for (let k = 0; k < 3; k++) {
    const a = (-half[k] - from[k]) / along[k], b = (half[k] - from[k]) / along[k];
    near = Math.max(near, Math.min(a, b));
    far = Math.min(far, Math.max(a, b));
  }
  return near <= far ? near : Infinity;
}
