// SPDX-License-Identifier: LGPL-2.1-or-later
// Draws the path by WebGL: each way between two rows as a piece of bead, as wide and high as it is laid.
"use strict";

// rows drawn while the path is turned, and where that is slow; rows up to which edges are smoothed; ms of a frame that is not
// fluent: the next ones are drawn with half of the pixels, and where that does not help with few rows
const COARSE = 8000, COARSEST = 2000, SMOOTH = 40000, SLOW = 40;
const BEAD_SHADER = `#version 300 es
uniform mat3 turn; uniform vec3 middle; uniform vec2 scale; uniform vec2 shift; uniform float depth;
uniform float pixel; uniform float high; uniform float wide; uniform float step; uniform vec3 low; uniform float rapids;
uniform vec2 widths; uniform vec2 values;
layout(location=0) in vec3 start; layout(location=1) in vec3 end; layout(location=2) in vec3 build;
layout(location=3) in float width; layout(location=4) in vec3 corner; layout(location=5) in float value;
out float across; out float share; out float known; out float isLaid; flat out vec3 side;
void main() {
  float laid = corner.z, beyond = corner.y - 1.0;
  vec3 a = turn * (low + step * start - middle), b = turn * (low + step * end - middle);
  vec2 along = b.xy - a.xy; float length_ = length(along);
  along = length_ > 1e-9 ? along / length_ : vec2(1.0, 0.0);
  vec2 beside = vec2(-along.y, along.x);
  float up = dot(beside, (turn * normalize(build)).xy);
  float w = width > 65534.5 || widths.y <= 0.0 ? wide : widths.x + widths.y * width;
  float half_ = 0.5 * sqrt(w * w * (1.0 - up * up) + high * high * up * up);
  half_ = max(laid > 0.5 ? half_ : 0.0, 0.7 * pixel);
  float reach = laid > 0.5 ? 0.4 * half_ : 0.0;
  vec3 at = mix(a, b, corner.x);
  at.xy += beside * beyond * half_ + along * (2.0 * corner.x - 1.0) * reach;
  across = beyond; side = vec3(beside, 0.0);
  known = value > 65534.5 ? 0.0 : 1.0; share = (value - values.x) * values.y; isLaid = laid;
  gl_Position = vec4(at.xy * scale + shift, -at.z * depth, 1.0);
  if (laid < 0.5 && rapids < 0.5) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`;
const BEAD_COLOUR = `#version 300 es
precision mediump float;
uniform sampler2D ramp; uniform vec3 rapid; uniform vec3 unknown;
in float across; in float share; in float known; in float isLaid; flat in vec3 side;
out vec4 colour;
void main() {
  if (isLaid < 0.5) { colour = vec4(rapid, 1.0); return; }
  vec3 own = known > 0.5 ? texture(ramp, vec2(clamp(share, 0.0, 1.0) * 0.996 + 0.002, 0.5)).rgb : unknown;
  vec3 normal = side * across + vec3(0.0, 0.0, sqrt(max(0.0, 1.0 - across * across)));
  float light = 0.42 + 0.58 * max(0.0, dot(normal, normalize(vec3(-0.35, 0.55, 0.75))));
  colour = vec4(own * light, 1.0);
}`;
const BODY_SHADER = `#version 300 es
uniform mat3 turn; uniform vec3 middle; uniform vec2 scale; uniform vec2 shift; uniform float depth; uniform float size;
layout(location=0) in vec3 place;
out vec3 eye;
void main() {
  eye = turn * (place - middle);
  gl_Position = vec4(eye.xy * scale + shift, -eye.z * depth, 1.0);
  gl_PointSize = size;
}`;
const BODY_COLOUR = `#version 300 es
precision mediump float;
uniform vec4 paint; uniform float kind;
in vec3 eye;
out vec4 colour;
void main() {
  float light = 1.0;
  if (kind > 1.5) { if (length(gl_PointCoord - 0.5) > 0.5) discard; }
  else if (kind > 0.5) {
    vec3 normal = normalize(cross(dFdx(eye), dFdy(eye)));
    light = 0.55 + 0.45 * abs(dot(normal, normalize(vec3(-0.35, 0.55, 0.75))));
  }
  colour = vec4(paint.rgb * light, paint.a);
}`;

function linked(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  const places = {};
  for (let at = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) - 1; at >= 0; at--) {
    const name = gl.getActiveUniform(program, at).name;
    places[name] = gl.getUniformLocation(program, name);
  }
  return { program, places };
}

function buffered(gl, values, kind = gl.ARRAY_BUFFER) {
  const buffer = gl.createBuffer();
  gl.bindBuffer(kind, buffer);
  gl.bufferData(kind, values, gl.STATIC_DRAW);
  return buffer;
}

// The path, the bodies around it, and points and lines on top. `path` holds the columns, `look` what is shown of them.
class Drawing {
  constructor(canvas, path) {
    const gl = canvas.getContext("webgl2", { antialias: path.rows < SMOOTH, preserveDrawingBuffer: true });
    if (!gl) throw new Error("no WebGL 2");
    this.canvas = canvas; this.gl = gl; this.path = path;
    this.beads = linked(gl, BEAD_SHADER, BEAD_COLOUR);
    this.bodies = linked(gl, BODY_SHADER, BODY_COLOUR);
    this.widths = path.columns.find((column) => column.name === "width");
    this.whole = new Pieces(gl, path, allRows(path), this.widths);
    this.coarse = path.rows > COARSE ? new Pieces(gl, path, someRows(path, COARSE), this.widths) : this.whole;
    this.shapes = path.bodies.map((body) => ({
      vertices: buffered(gl, body.vertices), count: body.triangles.length,
      triangles: buffered(gl, body.triangles, gl.ELEMENT_ARRAY_BUFFER),
    }));
    this.slow = 0;
    this.loose = gl.createBuffer();
    this.ramp = this.rampOf(path.ramp);
  }

  rampOf(colours) {
    const { gl } = this, texture = gl.createTexture(), data = new Uint8Array(colours.flatMap(parts));
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, colours.length, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, data);
    for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.LINEAR);
    for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
    return texture;
  }

  draw(camera, look) {
    const { gl, canvas } = this, ratio = look.moving && this.slow ? 0.5 : window.devicePixelRatio || 1;
    const wide = Math.round(canvas.clientWidth * ratio), high = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== wide || canvas.height !== high) { canvas.width = wide; canvas.height = high; }
    gl.viewport(0, 0, wide, high);
    gl.clearColor(...look.paper.map((part) => part / 255), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    this.drawBodies(camera, look);
    this.drawBeads(camera, look, ratio);
    this.drawLoose(camera, look, ratio);
  }

  // that the path is turned: how long the frame before took tells whether this is fluent
  turned(now, moving) {
    if (moving && this.before && now - this.before > SLOW && now - this.before < 20 * SLOW) this.slow++;
    this.before = moving ? now : 0;
  }

  pieces(moving) {
    if (!moving) return this.whole;
    if (this.slow < 2 || this.path.rows <= COARSEST) return this.coarse;
    if (!this.coarsest) this.coarsest = new Pieces(this.gl, this.path, someRows(this.path, COARSEST), this.widths);
    return this.coarsest;
  }

  seen(places, camera) {
    const { gl, canvas } = this;
    gl.uniformMatrix3fv(places.turn, true, camera.turn.flat());
    gl.uniform3fv(places.middle, camera.middle);
    gl.uniform2f(places.scale, 2 * camera.zoom / canvas.clientWidth, 2 * camera.zoom / canvas.clientHeight);
    gl.uniform2f(places.shift, 2 * camera.shift[0] / canvas.clientWidth, 2 * camera.shift[1] / canvas.clientHeight);
    gl.uniform1f(places.depth, 1 / camera.reach);
  }

  each(at, buffer, count, kind, stride, offset) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, count, kind, false, stride, offset);
  }

  drawBeads(camera, look, ratio) {
    const { gl, path } = this, { program, places } = this.beads, pieces = this.pieces(look.moving);
    const first = pieces.before(look.first), count = pieces.before(look.last + 1) - 1 - first;
    if (count < 1) return;
    gl.useProgram(program);
    this.seen(places, camera);
    const column = path.columns[look.column], { widths } = this;
    gl.uniform3fv(places.low, path.low); gl.uniform1f(places.step, path.step);
    gl.uniform1f(places.pixel, 1 / (camera.zoom * ratio)); gl.uniform1f(places.high, path.height);
    gl.uniform1f(places.wide, path.width); gl.uniform1f(places.rapids, look.rapids ? 1 : 0);
    gl.uniform2f(places.widths, widths ? widths.low : 0, widths ? (widths.high - widths.low) / STEPS : 0);
    const span = STEPS / Math.max(column.high - column.low, 1e-12), wide = (column.most - column.least) * span;
    gl.uniform2f(places.values, (column.least - column.low) * span, wide > 0 ? 1 / wide : 0);
    gl.uniform3fv(places.rapid, look.soft.map((part) => part / 255)); gl.uniform3f(places.unknown, 0.6, 0.6, 0.62);
    gl.bindTexture(gl.TEXTURE_2D, this.ramp);
    this.each(0, pieces.buffer, 3, gl.UNSIGNED_SHORT, PIECE, KINDS.start);
    this.each(1, pieces.buffer, 3, gl.UNSIGNED_SHORT, PIECE, KINDS.end);
    this.each(2, pieces.buffer, 3, gl.SHORT, PIECE, KINDS.build);
    this.each(3, pieces.buffer, 1, gl.UNSIGNED_SHORT, PIECE, KINDS.width);
    this.each(4, pieces.buffer, 3, gl.UNSIGNED_BYTE, PIECE, KINDS.corner);
    this.each(5, pieces.column(look.column), 1, gl.UNSIGNED_SHORT, 2, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, pieces.order);
    gl.drawElements(gl.TRIANGLES, 6 * count, gl.UNSIGNED_INT, 24 * first);
    for (let at = 1; at < 6; at++) gl.disableVertexAttribArray(at);
  }

  drawBodies(camera, look) {
    const { gl } = this, { program, places } = this.bodies;
    gl.useProgram(program);
    this.seen(places, camera);
    gl.uniform1f(places.kind, 1);
    gl.uniform4f(places.paint, ...look.body.map((part) => part / 255), 1);
    for (const shape of this.shapes) {
      this.each(0, shape.vertices, 3, gl.FLOAT, 0, 0);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, shape.triangles);
      gl.drawElements(gl.TRIANGLES, shape.count, gl.UNSIGNED_INT, 0);
    }
  }

  // points, lines and triangles that change: {kind: "points" | "lines" | "triangles", places, paint, size, on top}
  drawLoose(camera, look, ratio) {
    const { gl } = this, { program, places } = this.bodies;
    gl.useProgram(program);
    this.seen(places, camera);
    for (const some of look.loose) {
      if (!some.places.length) continue;
      gl.bindBuffer(gl.ARRAY_BUFFER, this.loose);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(some.places), gl.DYNAMIC_DRAW);
      this.each(0, this.loose, 3, gl.FLOAT, 0, 0);
      gl.uniform4f(places.paint, ...some.paint.map((part) => part / 255), 1);
      gl.uniform1f(places.size, (some.size || 1) * ratio);
      gl.uniform1f(places.kind, { points: 2, lines: 0, triangles: 1 }[some.kind]);
      if (some.onTop) gl.disable(gl.DEPTH_TEST); else gl.enable(gl.DEPTH_TEST);
      gl.drawArrays({ points: gl.POINTS, lines: gl.LINES, triangles: gl.TRIANGLES }[some.kind], 0, some.places.length / 3);
    }
    gl.enable(gl.DEPTH_TEST);
  }
}
