// SPDX-License-Identifier: BSD-3-Clause
// The scan in WebGL: points, grid, boxes, arrows, tails.

const POINT_VERTEX = `
attribute vec3 place;
uniform mat4 camera; uniform float step, size, ground; uniform vec3 tint, low, high; uniform int coloring;
varying vec3 color;
void main() {
  vec3 p = place * step;
  gl_Position = camera * vec4(p, 1.0);
  color = coloring == 0 ? tint : mix(low, high, clamp((p.z - ground) / 3.0, 0.0, 1.0));
  gl_PointSize = clamp(size / gl_Position.w, 1.5, 6.0);
}`;
const POINT_FRAGMENT = `
precision mediump float; varying vec3 color;
void main() { gl_FragColor = vec4(color, 1.0); }`;

// A line of some pixels: both its ends at each corner, which moves aside by half the thickness; soft at its sides.
const LINE_VERTEX = `
attribute vec3 place, other; attribute vec4 tint; attribute vec2 side;
uniform mat4 camera; uniform vec2 pixels;
varying vec4 color; varying float aside, half_width;
void main() {
  vec4 a = camera * vec4(place, 1.0), b = camera * vec4(other, 1.0);
  if (a.w < 0.1) a = mix(a, b, (0.1 - a.w) / max(b.w - a.w, 0.001));
  if (b.w < 0.1) b = mix(b, a, (0.1 - b.w) / max(a.w - b.w, 0.001));
  vec2 way = (b.xy / b.w - a.xy / a.w) * pixels;
  float n = length(way);
  vec2 across = n > 0.0 ? vec2(-way.y, way.x) / n : vec2(0.0);
  float moved = side.x + sign(side.x) * 0.7;
  gl_Position = a + vec4(across * moved / pixels * a.w, 0.0, 0.0);
  color = tint;
  aside = moved * side.y;
  half_width = abs(moved);
}`;
const LINE_FRAGMENT = `
precision mediump float; varying vec4 color; varying float aside, half_width;
void main() { gl_FragColor = vec4(color.rgb, color.a * clamp((half_width - abs(aside)) / 1.1, 0.0, 1.0)); }`;
const FLAT_VERTEX = `
attribute vec3 place; attribute vec4 tint; uniform mat4 camera; varying vec4 color;
void main() { gl_Position = camera * vec4(place, 1.0); color = tint; }`;
const COLOR_FRAGMENT = `
precision mediump float; varying vec4 color;
void main() { gl_FragColor = color; }`;

const GRID_VERTEX = `
attribute vec2 corner; uniform mat4 camera; uniform vec3 origin; uniform vec2 extent; varying vec2 at;
void main() { at = corner; gl_Position = camera * vec4(origin + vec3(corner * extent, 0.0), 1.0); }`;
const GRID_FRAGMENT = `
precision mediump float; varying vec2 at; uniform sampler2D cells; uniform vec3 free, occupied;
void main() {
  float state = texture2D(cells, at).r * 255.0;
  if (state < 0.5) discard;
  gl_FragColor = state < 1.5 ? vec4(free, 1.0) : vec4(occupied, 1.0);
}`;

class View {
  constructor(canvas) {
    this.canvas = canvas;
    this.camera = new Camera();
    this.layers = { points: true, ground: true, grid: true, boxes: true, structure: true, tails: true, labels: true };
    this.coloring = 0;
    this.share = 1; // of the background's points that is drawn
    const gl = this.gl = canvas.getContext("webgl", { alpha: false, antialias: false, preserveDrawingBuffer: true });
    if (!gl) throw new Error("This browser shows no WebGL: the scans cannot be drawn.");
    this.programs = {
      points: this.program(POINT_VERTEX, POINT_FRAGMENT), lines: this.program(LINE_VERTEX, LINE_FRAGMENT),
      faces: this.program(FLAT_VERTEX, COLOR_FRAGMENT), grid: this.program(GRID_VERTEX, GRID_FRAGMENT),
    };
    this.buffers = Object.fromEntries(["points", "lines", "faces", "grid"].map((name) => [name, gl.createBuffer()]));
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.grid);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([0, 0, 1, 0, 0, 1, 1, 1]), gl.STATIC_DRAW);
    this.texture = gl.createTexture();
    this.points = this.grid = null;
    this.lineCount = this.faceCount = 0;
  }

  program(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    const of = (kind, get) => {
      const list = {};
      for (let k = 0; k < gl.getProgramParameter(program, kind); k++) {
        const name = (kind === gl.ACTIVE_UNIFORMS ? gl.getActiveUniform(program, k) : gl.getActiveAttrib(program, k)).name;
        list[name.replace("[0]", "")] = get.call(gl, program, name);
      }
      return list;
    };
    return { program, uniforms: of(gl.ACTIVE_UNIFORMS, gl.getUniformLocation), attributes: of(gl.ACTIVE_ATTRIBUTES, gl.getAttribLocation) };
  }

  /** Colours of the theme, as numbers from 0 to 1. */
  readColors() {
    const style = getComputedStyle(document.documentElement);
    const rgb = (name) => {
      const hex = style.getPropertyValue("--" + name).trim();
      return [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16) / 255);
    };
    this.colors = Object.fromEntries([...KINDS, "scene", "rings", "free", "occupied", "speed", "accent", "text"].map((name) => [name, rgb(name)]));
  }

  setScan(scan) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.points);
    gl.bufferData(gl.ARRAY_BUFFER, scan.points, gl.DYNAMIC_DRAW);
    this.points = scan.counts;
    this.grid = scan.grid.columns > 0 ? scan.grid : null;
    this.groundZ = scan.grid.z;
    if (!this.grid) return;
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.LUMINANCE, this.grid.columns, this.grid.rows, 0, gl.LUMINANCE, gl.UNSIGNED_BYTE, this.grid.states);
    for (const [name, value] of [[gl.TEXTURE_MIN_FILTER, gl.NEAREST], [gl.TEXTURE_MAG_FILTER, gl.NEAREST],
      [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]]) gl.texParameteri(gl.TEXTURE_2D, name, value);
  }

  /** Lines and faces of a scan: rings, boxes, arrows, tails (lists of places by obstacle). */
  setObjects(obstacles, tails, picked) {
    const lines = [], faces = [];
    const line = (a, b, rgb, alpha, wide) => {
      for (const [p, q, side, end] of [[a, b, 1, 1], [a, b, -1, 1], [b, a, 1, -1], [a, b, 1, 1], [b, a, 1, -1], [b, a, -1, -1]])
        lines.push(...p, ...q, ...rgb, alpha, side * wide, end);
    };
    this.addRings(line);
    for (const o of obstacles) {
      const isStructure = o.cls === STRUCTURE, isPicked = picked !== null && o.id === picked;
      if (!isPicked && !(isStructure ? this.layers.structure : this.layers.boxes)) continue;
      const rgb = this.colors[CLASSES[o.cls]], corners = cornersOf(o);
      const alpha = isPicked ? 1 : o.seen ? (isStructure ? 0.45 : 1) : 0.4;
      for (const [a, b] of EDGES) line(corners[a], corners[b], rgb, alpha, isPicked ? 1.5 : isStructure ? 0.3 : 0.7);
      for (const face of FACES) {
        if (isStructure && !isPicked) break;
        for (const k of [0, 1, 2, 0, 2, 3]) faces.push(...corners[face[k]], ...rgb, isPicked ? 0.3 : 0.1);
      }
      if (!isStructure) this.addArrows(line, o, rgb, alpha);
    }
    if (this.layers.tails) for (const { rgb, places } of tails)
      for (let k = 1; k < places.length; k++) line(places[k - 1], places[k], rgb, 0.25 + 0.55 * k / places.length, 0.7);
    this.upload(lines, faces);
  }

  upload(lines, faces) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.lines);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(lines), gl.DYNAMIC_DRAW);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.faces);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(faces), gl.DYNAMIC_DRAW);
    this.lineCount = lines.length / 12;
    this.faceCount = faces.length / 7;
  }

  addRings(line) {
    const z = this.groundZ ?? 0, kSides = 48;
    for (let r = 10; r <= 60; r += 10) {
      for (let k = 0; k < kSides; k++) {
        const [a, b] = [k, k + 1].map((n) => [r * Math.cos(n * 2 * Math.PI / kSides), r * Math.sin(n * 2 * Math.PI / kSides), z]);
        line(a, b, this.colors.rings, 0.9, 0.2);
      }
    }
    // The vehicle: an arrow head that points forward.
    const body = [[1.6, 0, z], [-1.2, 0.8, z], [-0.6, 0, z], [-1.2, -0.8, z]];
    body.forEach((p, k) => line(p, body[(k + 1) % 4], this.colors.text, 1, 0.8));
  }

  addArrows(line, o, rgb, alpha) {
    const arrow = (from, yaw, length, color) => {
      const at = (r, turned) => [from[0] + r * Math.cos(yaw + turned), from[1] + r * Math.sin(yaw + turned), from[2]];
      const tip = at(length, 0), head = Math.min(0.7, 0.4 * length);
      line(from, tip, color, alpha, 0.8);
      for (const turned of [2.6, -2.6]) line(tip, [tip[0] + head * Math.cos(yaw + turned), tip[1] + head * Math.sin(yaw + turned), tip[2]], color, alpha, 0.8);
    };
    if (o.headingValid) arrow([o.x + Math.cos(o.yaw) * o.length / 2, o.y + Math.sin(o.yaw) * o.length / 2, o.z], o.yaw, 1, rgb);
    if (o.moving && o.speed > 0.2) arrow([o.x, o.y, o.z + o.height / 2], Math.atan2(o.vy, o.vx), o.speed, this.colors.speed);
  }

  draw() {
    const gl = this.gl, { width, height } = this.canvas;
    const camera = this.camera.matrix(width / height);
    gl.viewport(0, 0, width, height);
    gl.clearColor(...this.colors.scene, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    if (this.grid && this.layers.grid) this.drawGrid(camera);
    if (this.points && this.layers.points) this.drawPoints(camera, height);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    this.drawFlat(camera);
    this.drawLines(camera, width, height);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
    return camera;
  }

  use(name, camera, layout, stride) {
    const gl = this.gl, { program, uniforms, attributes } = this.programs[name];
    gl.useProgram(program);
    gl.uniformMatrix4fv(uniforms.camera, false, camera);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[name]);
    for (let k = 0; k < 8; k++) gl.disableVertexAttribArray(k);
    for (const [attribute, size, type, offset] of layout) {
      gl.enableVertexAttribArray(attributes[attribute]);
      gl.vertexAttribPointer(attributes[attribute], size, type, false, stride, offset);
    }
    return uniforms;
  }

  /** Points lie in the buffer kind by kind. */
  drawPoints(camera, height) {
    const gl = this.gl, u = this.use("points", camera, [["place", 3, gl.SHORT, 0]], 6);
    gl.uniform1f(u.step, this.step);
    gl.uniform1f(u.ground, this.groundZ);
    gl.uniform1i(u.coloring, this.coloring);
    gl.uniform3fv(u.low, this.colors.accent);
    gl.uniform3fv(u.high, this.colors.vehicle);
    for (let k = 0, first = 0; k < KINDS.length; first += this.points[k++]) {
      const isThing = ["unknown", "vehicle", "pedestrian", "cyclist"].includes(KINDS[k]);
      if (this.points[k] === 0 || (KINDS[k] === "ground" && !this.layers.ground)) continue;
      gl.uniform3fv(u.tint, this.colors[KINDS[k]]);
      gl.uniform1f(u.size, (isThing ? 0.115 : 0.08) * height);
      gl.drawArrays(gl.POINTS, first, isThing ? this.points[k] : Math.ceil(this.share * this.points[k]));
    }
  }

  drawGrid(camera) {
    const gl = this.gl, g = this.grid, u = this.use("grid", camera, [["corner", 2, gl.FLOAT, 0]], 8);
    gl.uniform3f(u.origin, g.x, g.y, g.z - 0.15);
    gl.uniform2f(u.extent, g.columns * g.size, g.rows * g.size);
    gl.uniform3fv(u.free, this.colors.free);
    gl.uniform3fv(u.occupied, this.colors.occupied);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }

  drawLines(camera, width, height) {
    const gl = this.gl;
    const u = this.use("lines", camera, [["place", 3, gl.FLOAT, 0], ["other", 3, gl.FLOAT, 12], ["tint", 4, gl.FLOAT, 24], ["side", 2, gl.FLOAT, 40]], 48);
    const dots = window.devicePixelRatio || 1;
    gl.uniform2f(u.pixels, width / 2 / dots, height / 2 / dots);
    gl.drawArrays(gl.TRIANGLES, 0, this.lineCount);
  }

  drawFlat(camera) {
    const gl = this.gl;
    this.use("faces", camera, [["place", 3, gl.FLOAT, 0], ["tint", 4, gl.FLOAT, 12]], 28);
    gl.drawArrays(gl.TRIANGLES, 0, this.faceCount);
  }
}
