# SPDX-License-Identifier: LGPL-2.1-or-later
"""The part of the page that shows the path to turn and to step through, with its data and its script."""

from __future__ import annotations

import base64
import hashlib
import json
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from freecad_am.core.geometry.obstacles import Body, disc
from freecad_am.core.toolpath import Toolpath
from freecad_am.plots.look import shade

from .. import units
from .columns import Bytes, Shown, packed

_HERE = Path(__file__).resolve().parent
_SCRIPTS = ("camera.js", "pieces.js", "drawing.js", "viewer.js")
_MOST_TRIANGLES = 30_000  # of the bodies around the path
_SHADES = 32

_CONTROLS = """<div class="row"><label>colour <select name="colour"></select></label><span class="least"></span>
<span class="ramp"></span><span class="most"></span><label><input type="checkbox" name="rapids"/>rapids</label>
<label><input type="checkbox" name="directions"/>build directions</label>
<button name="above">Above</button><button name="front">Front</button><button name="side">Side</button>
<button name="reset">Reset view</button></div>
<canvas tabindex="0" role="img" aria-label="the path, to turn and to step through"></canvas>
<div class="row"><label class="wide">layers <input type="range" name="from" min="0" value="0" aria-label="first layer"/>
<input type="range" name="to" min="0" aria-label="last layer"/><span class="layers"></span></label></div>
<div class="row"><button name="play">Play</button><button name="back" aria-label="a point back">&lsaquo;</button>
<button name="on" aria-label="a point on">&rsaquo;</button><label class="wide">up to
<input type="range" name="row" aria-label="point"/></label><button name="whole">Whole path</button></div>
<div class="told" role="status"></div>
<div class="row hint">Drag to turn, with Shift to move; click a bead to read it; after a click the wheel and + and - enlarge,
, and . step.</div>"""


@dataclass(frozen=True)
class Turned:
    """The pieces of a page: its element, and its data and script for the end of the body."""

    element: str
    data: str


def turned(of: Shown, toolpath: Toolpath, width: float, platform: float | None) -> Turned:
    """The path of a job with the bodies around it. width: mm, of beads that tell none. platform: its diameter, mm, None
    without one."""
    into = Bytes()
    facts = packed(of, into)
    bodies = [*toolpath.surroundings, *([disc(platform, toolpath.frame)] if platform else [])]
    every = max(1, -(-sum(len(body.triangles) for body in bodies) // _MOST_TRIANGLES))
    facts["bodies"] = [_body(body, every, into) for body in bodies]
    facts["box"] = _box(of)
    facts["length"] = units.scale(float(np.abs(facts["box"]).max()), "mm")
    facts["upright"] = toolpath.frame[:3, :3].T.tolist()
    facts["height"] = toolpath.layer_height
    facts["width"] = width
    facts["ramp"] = [shade(k / (_SHADES - 1)) for k in range(_SHADES)]
    left_out = len(of.motion) - len(of.rows)
    note = f"; {left_out:,} points between are left out here" if left_out else ""
    caption = f"<figcaption>The path with its beads{note}. Underlined places in the tables are shown here.</figcaption>"
    data = json.dumps(facts, separators=(",", ":")).replace("<", "\\u003c")
    return Turned(
        f'<figure class="turned" id="path" hidden>{_CONTROLS}{caption}</figure>',
        f'<script type="application/json" id="path-facts">{data}</script>'
        f'<script type="text/plain" id="path-columns">{into.text()}</script><script>{script()}</script>',
    )


@lru_cache(maxsize=1)
def script() -> str:
    """The script of the page, in a scope of its own."""
    text = "".join((_HERE / name).read_text(encoding="utf-8") for name in _SCRIPTS)
    return f"(() => {{\n{text}}})();\n"


@lru_cache(maxsize=1)
def style() -> str:
    """How the element looks."""
    return (_HERE / "viewer.css").read_text(encoding="utf-8")


def policy() -> str:
    """What a browser lets the page do: draw itself and run this script, nothing else, and fetch nothing."""
    digest = base64.b64encode(hashlib.sha256(script().encode()).digest()).decode()
    return f"default-src 'none'; style-src 'unsafe-inline'; script-src 'sha256-{digest}'"


def _body(body: Body, every: int, into: Bytes) -> dict[str, Any]:
    """A body as bytes, of large ones each so many-th triangle."""
    return {
        "name": body.name,
        "vertices": into.add(body.vertices, "f4"),
        "triangles": into.add(body.triangles[::every], "u4"),
    }


def _box(of: Shown) -> list[list[float]]:
    """Least and largest corner of what is laid, which the view turns about."""
    deposited = of.motion.position[of.motion.deposit]
    return np.stack([deposited.min(axis=0), deposited.max(axis=0)]).tolist()
