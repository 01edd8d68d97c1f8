// SPDX-License-Identifier: LGPL-2.1-or-later
// How the path is looked at: turned about its middle, without perspective, so that lengths can be compared.
"use strict";

const times = (a, b) => a.map((row) => [0, 1, 2].map((k) => row[0] * b[0][k] + row[1] * b[1][k] + row[2] * b[2][k]));
const applied = (a, v) => a.map((row) => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);
const about = (axis, angle) => {
  const c = Math.cos(angle), s = Math.sin(angle);
  return { x: [[1, 0, 0], [0, c, -s], [0, s, c]], z: [[c, -s, 0], [s, c, 0], [0, 0, 1]] }[axis];
};

function farthest(vertices, middle) {
  let most = 0;
  for (let at = 0; at < vertices.length; at += 3) {
    most = Math.max(most, Math.hypot(...middle.map((value, k) => vertices[at + k] - value)));
  }
  return most;
}

class Camera {
  // low, high: corners of what is looked at, mm; upright: rows of a turn after which z is up; bodies: what stands around it
  constructor([low, high], upright, bodies) {
    this.upright = upright; this.box = [low, high];
    this.middle = low.map((value, k) => 0.5 * (value + high[k]));
    this.radius = Math.max(1e-6, Math.hypot(...low.map((value, k) => high[k] - value)));
    this.reach = bodies.flatMap((body) => farthest(body.vertices, this.middle)).reduce((a, b) => Math.max(a, b), this.radius);
    this.reset(1, 1);
  }

  // look from the side and a little from above, all of the box on a canvas of so many pixels
  reset(wide, high) {
    this.azimuth = -28; this.elevation = 24; this.fit(wide, high);
  }

  fit(wide, high) {
    this.zoom = 1; this.shift = [0, 0];
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((n) => this.seen([0, 1, 2].map((k) => this.box[n >> k & 1][k])));
    const [across, up] = [0, 1].map((k) => Math.max(1e-6, ...corners.map((one) => 2 * Math.abs(one[k]))));
    this.zoom = 0.86 * Math.min(wide / across, high / up); // pixels to a mm
  }

  get turn() {
    const radians = Math.PI / 180;
    return times(times(about("x", (this.elevation - 90) * radians), about("z", this.azimuth * radians)), this.upright);
  }

  orbit(right, down) {
    this.azimuth += 0.4 * right;
    this.elevation = Math.min(180, Math.max(-180, this.elevation + 0.4 * down));
  }

  // keep what is under the pointer, `at` in pixels from the middle of the canvas, upwards
  enlarge(factor, at) {
    const most = 2e4 / this.radius * 50, zoom = Math.min(most, Math.max(20 / this.radius, this.zoom * factor));
    this.shift = this.shift.map((value, k) => at[k] + (value - at[k]) * zoom / this.zoom);
    this.zoom = zoom;
  }

  // pixels from the middle of the canvas, upwards, and how near to the eye
  seen(place) {
    const eye = applied(this.turn, place.map((value, k) => value - this.middle[k]));
    return [eye[0] * this.zoom + this.shift[0], eye[1] * this.zoom + this.shift[1], eye[2]];
  }
}
