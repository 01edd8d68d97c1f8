// SPDX-License-Identifier: LGPL-2.1-or-later
// The path as triangles: each way between two rows is a piece of four corners, of 24 bytes each: where it starts and ends, the
// build direction, the width, and which corner it is. Not as instances of one piece, which browsers without a graphics card
// draw one by one.
"use strict";

const PIECE = 24, KINDS = { start: 0, end: 6, build: 12, width: 18, corner: 20 };

// Pieces through some of the rows, in order.
class Pieces {
  constructor(gl, path, rows, widths) {
    this.gl = gl; this.path = path; this.rows = rows;
    this.buffer = buffered(gl, corners(path, rows, widths));
    this.order = buffered(gl, triangles(rows.length - 1), gl.ELEMENT_ARRAY_BUFFER);
    this.columns = path.columns.map(() => null); // made when one is asked for
  }

  // the values of a column at the end of each piece, four times each
  column(at) {
    if (!this.columns[at]) {
      const { values } = this.path.columns[at], found = new Uint16Array(4 * (this.rows.length - 1));
      for (let piece = 1; piece < this.rows.length; piece++) found.fill(values[this.rows[piece]], 4 * piece - 4, 4 * piece);
      this.columns[at] = buffered(this.gl, found);
    }
    return this.columns[at];
  }

  // the number of rows before one
  before(row) {
    let low = 0, high = this.rows.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.rows[middle] < row) low = middle + 1; else high = middle;
    }
    return low;
  }
}

function corners(path, rows, widths) {
  const words = new Uint16Array((rows.length - 1) * 4 * PIECE / 2), bytes = new Uint8Array(words.buffer);
  const build = new Uint16Array(path.build.buffer, path.build.byteOffset, path.build.length);
  for (let piece = 1, at = 0; piece < rows.length; piece++) {
    const start = 3 * rows[piece - 1], end = 3 * rows[piece];
    for (let corner = 0; corner < 4; corner++, at += PIECE / 2) {
      for (let k = 0; k < 3; k++) {
        words[at + k] = path.position[start + k];
        words[at + 3 + k] = path.position[end + k];
        words[at + 6 + k] = build[end + k];
      }
      words[at + 9] = widths ? widths.values[rows[piece]] : NONE;
      bytes.set([corner >> 1, 2 * (corner & 1), path.laid[rows[piece]], 0], 2 * at + KINDS.corner);
    }
  }
  return words;
}

function triangles(count) {
  const found = new Uint32Array(6 * count);
  for (let piece = 0, at = 0; piece < count; piece++) {
    for (const corner of [0, 1, 2, 2, 1, 3]) found[at++] = 4 * piece + corner;
  }
  return found;
}

// all rows, and those that are drawn while the path is turned: every so many-th of each bead with its ends
const allRows = (path) => Uint32Array.from({ length: path.rows }, (_, row) => row);

function someRows(path, most) {
  const every = Math.ceil(path.rows / most), found = [];
  path.blocks.forEach(([, , first], at) => {
    const last = at + 1 < path.blocks.length ? path.blocks[at + 1][2] - 1 : path.rows - 1;
    for (let row = first; row < last; row += every) found.push(row);
    found.push(last);
  });
  return Uint32Array.from(found);
}
