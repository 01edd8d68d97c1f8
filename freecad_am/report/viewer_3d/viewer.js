// SPDX-License-Identifier: LGPL-2.1-or-later
// The path of the report: reads its columns from the page, and answers mouse, keys and fields.
"use strict";

const STEPS = 65534, NONE = 65535, UNIT = 32767, SPENT = 20, REST = 200; // s that playing the layers shown takes; ms at rest
const parts = (colour) => {
  const long = colour.length === 4 ? colour.replace(/[0-9a-f]/gi, (digit) => digit + digit) : colour;
  return [1, 3, 5].map((at) => parseInt(long.slice(at, at + 2), 16));
};

// columns of bytes become arrays of numbers
function readPath(facts, text) {
  const bytes = Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0)).buffer;
  const kinds = { u1: Uint8Array, u2: Uint16Array, i2: Int16Array, u4: Uint32Array, f4: Float32Array };
  const column = (place) => new kinds[place.kind](bytes, place.at, place.count);
  const path = { ...facts };
  for (const name of ["position", "build", "tool", "laid", "time", "point"]) path[name] = column(facts[name]);
  for (const name of ["columns", "axes"]) path[name] = facts[name].map((one) => ({ ...one, values: column(one.values) }));
  path.bodies = facts.bodies.map((one) => ({ vertices: column(one.vertices), triangles: column(one.triangles) }));
  path.at = (row) => [0, 1, 2].map((k) => path.low[k] + path.step * path.position[3 * row + k]);
  path.along = (name, row) => [0, 1, 2].map((k) => path[name][3 * row + k] / UNIT);
  path.value = (one, row) => (one.values[row] === NONE ? NaN : one.low + (one.high - one.low) * one.values[row] / STEPS);
  return path;
}

class Viewer {
  constructor(root, path) {
    this.root = root; this.path = path; this.canvas = root.querySelector("canvas");
    this.drawing = new Drawing(this.canvas, path);
    this.camera = new Camera(path.box, path.upright, path.bodies);
    this.layers = this.rowsOfLayers();
    this.look = { column: 0, rapids: false, directions: false, from: 0, to: this.layers.length - 1, row: path.rows - 1 };
    this.marks = [...document.querySelectorAll("[data-row]")].map((one) => Number(one.dataset.row));
    this.held = new Map(); // pointers that are down on the canvas
    this.fields();
    this.pointer();
    this.camera.reset(this.canvas.clientWidth, this.canvas.clientHeight);
    new ResizeObserver(() => this.redraw()).observe(this.canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.redraw());
    this.show({});
  }

  // first and last row of each layer in the order of the path
  rowsOfLayers() {
    const found = [];
    for (const [layer, , first] of this.path.blocks) {
      if (!found.length || found[found.length - 1].layer !== layer) found.push({ layer, first });
    }
    found.forEach((one, at) => { one.last = at + 1 < found.length ? found[at + 1].first - 1 : this.path.rows - 1; });
    return found;
  }

  field(name) { return this.root.querySelector(`[name=${name}]`); }

  fields() {
    const { path } = this, last = this.layers.length - 1;
    this.field("colour").replaceChildren(...path.columns.map((one, at) => new Option(one.name, at)));
    for (const name of ["from", "to"]) this.field(name).max = last;
    this.field("to").value = last;
    const heard = {
      colour: (value) => ({ column: Number(value) }),
      from: (value) => ({ from: Number(value), to: Math.max(Number(value), this.look.to) }),
      to: (value) => ({ to: Number(value), from: Math.min(Number(value), this.look.from), row: this.layers[Number(value)].last }),
      row: (value) => ({ row: Number(value) }),
    };
    for (const [name, change] of Object.entries(heard)) {
      this.field(name).addEventListener("input", (event) => this.step(change(event.target.value)));
    }
    for (const name of ["rapids", "directions"]) {
      this.field(name).addEventListener("change", (event) => this.show({ [name]: event.target.checked }));
    }
    const pressed = {
      back: () => this.step({ row: this.look.row - 1 }), on: () => this.step({ row: this.look.row + 1 }),
      play: () => this.play(), whole: () => { this.stop(); this.show({ from: 0, to: last, row: path.rows - 1 }); },
      reset: () => { this.camera.reset(this.canvas.clientWidth, this.canvas.clientHeight); this.redraw(); },
    };
    for (const [name, act] of Object.entries(pressed)) this.field(name).addEventListener("click", act);
    for (const [name, azimuth, elevation] of [["above", 0, 90], ["front", 0, 0], ["side", -90, 0]]) {
      this.field(name).addEventListener("click", () => {
        Object.assign(this.camera, { azimuth, elevation });
        this.camera.fit(this.canvas.clientWidth, this.canvas.clientHeight);
        this.redraw();
      });
    }
    for (const one of document.querySelectorAll("[data-row]")) {
      one.addEventListener("click", () => { this.go(Number(one.dataset.row)); this.root.scrollIntoView({ behavior: "smooth" }); });
    }
  }

  pointer() {
    const { canvas, held } = this;
    const place = (event) => {
      const box = canvas.getBoundingClientRect();
      return [event.clientX - box.left - 0.5 * box.width, 0.5 * box.height - (event.clientY - box.top)];
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      held.set(event.pointerId, { at: place(event), moved: 0 });
    });
    canvas.addEventListener("pointermove", (event) => {
      const mine = held.get(event.pointerId);
      if (!mine) return;
      const now = place(event), right = now[0] - mine.at[0], up = now[1] - mine.at[1];
      if (held.size === 2) {
        const other = [...held.values()].find((one) => one !== mine).at;
        const before = Math.hypot(mine.at[0] - other[0], mine.at[1] - other[1]);
        this.camera.enlarge(Math.hypot(now[0] - other[0], now[1] - other[1]) / Math.max(1, before), other);
      } else if (event.shiftKey || event.buttons & 6) {
        this.camera.shift = [this.camera.shift[0] + right, this.camera.shift[1] + up];
      } else this.camera.orbit(right, -up);
      mine.at = now; mine.moved += Math.hypot(right, up);
      this.move();
    });
    const end = (event) => {
      const mine = held.get(event.pointerId);
      held.delete(event.pointerId);
      if (this.look.moving) this.redraw();
      if (mine && mine.moved < 4 && event.type === "pointerup") this.pick(mine.at);
    };
    for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, end);
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      if (document.activeElement !== canvas && !event.ctrlKey) return; // the page goes on
      event.preventDefault();
      this.camera.enlarge(Math.exp(-0.0015 * event.deltaY), place(event));
      this.move();
    }, { passive: false });
    const keys = {
      ArrowLeft: () => this.camera.orbit(-12, 0), ArrowRight: () => this.camera.orbit(12, 0),
      ArrowUp: () => this.camera.orbit(0, -12), ArrowDown: () => this.camera.orbit(0, 12),
      "+": () => this.camera.enlarge(1.2, [0, 0]), "-": () => this.camera.enlarge(1 / 1.2, [0, 0]),
      ",": () => this.step({ row: this.look.row - 1 }), ".": () => this.step({ row: this.look.row + 1 }),
    };
    canvas.addEventListener("keydown", (event) => {
      if (!keys[event.key]) return;
      event.preventDefault();
      keys[event.key]();
      this.redraw();
    });
  }

  // the row shown that is nearest to a place on the canvas, in front where two are as near
  pick(at) {
    const { first, last } = this.range(), { path } = this;
    let best = -1, least = 14;
    for (let row = first; row <= last; row++) {
      if (!this.look.rapids && !path.laid[row] && !path.laid[row + 1]) continue;
      const seen = this.camera.seen(path.at(row));
      const apart = Math.hypot(seen[0] - at[0], seen[1] - at[1]) - 1e-3 * seen[2] * this.camera.zoom;
      if (apart < least) { least = apart; best = row; }
    }
    if (best >= 0) this.show({ row: best });
  }

  range() { return { first: this.layers[this.look.from].first, last: this.layers[this.look.to].last }; }

  // show the layers up to a row, and that row
  go(row) {
    this.stop();
    const layer = this.layers.findIndex((one) => row <= one.last);
    this.show({ from: Math.min(this.look.from, layer), to: Math.max(this.look.to, layer), row });
  }

  show(changes) {
    Object.assign(this.look, changes);
    const { first, last } = this.range(), field = this.field("row");
    this.look.row = Math.min(last, Math.max(first, this.look.row));
    field.min = first; field.max = last; field.value = this.look.row;
    this.field("from").value = this.look.from; this.field("to").value = this.look.to;
    this.root.querySelector(".layers").textContent = `${this.layers[this.look.from].layer} to ${this.layers[this.look.to].layer}`;
    this.tell();
    this.redraw();
  }

  // the same where more such changes follow soon
  step(changes) {
    this.move();
    this.show(changes);
  }

  play() {
    if (this.timer) { this.stop(); return; }
    const { first, last } = this.range(), start = this.look.row < last ? this.look.row : first;
    const began = performance.now(), rows = last - first;
    this.field("play").textContent = "Stop";
    const frame = (now) => {
      const row = start + Math.round(Math.max(0, now - began) / 1000 / SPENT * rows);
      this.look.moving = true;
      this.show({ row });
      if (row < last) this.timer = requestAnimationFrame(frame); else this.stop();
    };
    this.timer = requestAnimationFrame(frame);
  }

  stop() {
    cancelAnimationFrame(this.timer);
    this.timer = 0;
    this.move();
    this.field("play").textContent = "Play";
  }

  // draw coarsely, and all of it once the path has come to rest: REST after the last frame, and not while it is held, or a
  // frame that takes longer would be followed by one of everything
  move() {
    this.look.moving = true;
    this.redraw();
  }

  redraw() {
    if (this.asked) return;
    clearTimeout(this.rest);
    this.asked = requestAnimationFrame((now) => {
      this.asked = 0;
      this.drawing.turned(now, this.look.moving);
      this.drawNow();
      if (!this.look.moving || this.timer || this.held.size) return;
      this.rest = setTimeout(() => { this.look.moving = false; this.redraw(); }, REST);
    });
  }

  drawNow() {
    const style = getComputedStyle(this.root), colour = (name) => parts(style.getPropertyValue(name).trim());
    const { path, look } = this, { first } = this.range(), bad = colour("--bad"), ink = colour("--ink");
    const marks = this.marks.filter((row) => row >= first && row <= look.row).flatMap((row) => path.at(row));
    const loose = [{ kind: "points", places: marks, paint: bad, size: 10, onTop: true }];
    if (look.directions) loose.push({ kind: "lines", places: this.strokes(first, look.row), paint: ink });
    loose.push({ kind: "triangles", places: this.nozzle(look.row), paint: [214, 140, 60] });
    this.drawing.draw(this.camera, {
      ...look, first, last: look.row, loose, paper: colour("--paper"), soft: colour("--soft"), body: [168, 177, 192],
    });
  }

  strokes(first, last) {
    const { path } = this, long = 0.05 * this.camera.radius, every = Math.max(1, Math.round((last - first) / 600)), found = [];
    for (let row = first; row <= last; row += every) {
      const at = path.at(row), along = path.along("build", row);
      if (path.laid[row]) found.push(...at, ...at.map((value, k) => value + long * along[k]));
    }
    return found;
  }

  // a cone along the tool with its tip at a row
  nozzle(row) {
    const at = this.path.at(row), z = this.path.along("tool", row), long = 0.06 * this.camera.radius, found = [];
    const other = Math.abs(z[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0];
    const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    const x = cross(other, z), size = Math.hypot(...x), y = cross(z, x);
    const rim = (angle) => at.map((value, k) => {
      const beside = (Math.cos(angle) * x[k] + Math.sin(angle) * y[k]) / size;
      return value + long * (z[k] + 0.25 * beside);
    });
    for (let k = 0; k < 20; k++) found.push(...at, ...rim(k * Math.PI / 10), ...rim((k + 1) * Math.PI / 10));
    return found;
  }

  // the row in words, and what the colours mean
  tell() {
    const { path, look } = this, [perMm, lengthUnit] = path.length, row = look.row, block = path.blocks.filter((one) => one[2] <= row).pop();
    const number = (value, unit) => (Number.isNaN(value) ? "-" : `${value.toFixed(unit === "" ? 3 : 2)}${unit ? ` ${unit}` : ""}`);
    const minutes = Math.floor(path.time[row] / 60), seconds = (path.time[row] % 60).toFixed(1).padStart(4, "0");
    const words = [
      `layer ${block[0]} bead ${block[1]}${block[3] ? ` point ${path.point[row]}` : ", rapid"}`, `${minutes}:${seconds} min`,
      `x y z ${path.at(row).map((value) => (perMm * value).toFixed(perMm === 1 ? 2 : 3)).join(" ")} ${lengthUnit}`,
      ...path.columns.slice(1).map((one) => `${one.name} ${number(path.value(one, row), one.unit)}`),
      path.axes.map((one) => `${one.name} ${number(path.value(one, row), one.unit)}`).join(" "),
    ];
    this.root.querySelector(".told").textContent = words.filter(Boolean).join(" · ");
    const column = path.columns[look.column], digits = column.unit || column.name !== "layer" ? 3 : 6;
    this.root.querySelector(".least").textContent = Number(column.least.toPrecision(digits));
    this.root.querySelector(".most").textContent = `${Number(column.most.toPrecision(digits))} ${column.unit}`;
  }
}

try {
  const facts = JSON.parse(document.getElementById("path-facts").textContent);
  const path = readPath(facts, document.getElementById("path-columns").textContent);
  const root = document.getElementById("path");
  root.hidden = false;
  root.querySelector(".ramp").style.background = `linear-gradient(to right, ${facts.ramp.join(",")})`;
  window.pathViewer = new Viewer(root, path);
  document.getElementById("path-still").hidden = true;
} catch (error) {
  document.getElementById("path").hidden = true; // the picture stays
  console.error(error);
}
