# SPDX-License-Identifier: LGPL-2.1-or-later
"""Small planned jobs for each post, motion and set-up: short beads on three sides of a cone, so
that each travel must pass it, with waits, an input, a call and several layers between them. Beads
of two sides start or end at other speeds."""

import dataclasses
import functools
import math

import numpy as np

from freecad_am.core.geometry.developable import Developable
from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.issues import has_errors
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import BetweenLayersParameters, ProcessParameters
from freecad_am.core.parameters.program import NcParameters, ProgramParameters
from freecad_am.core.planning.beads import steps
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.toolpath import Bead, BeadEnds, Layer, MotionRules, Toolpath
from freecad_am.posts import catalogue
from tests.programs import build

CHORD_ERROR, SPEED, SIDES, LIFT = 0.05, 8.0, 3, 20.0
WIDTH, HEIGHT = 8.0, 3.0  # bead size in mm
# for each side: mm of a bead at its start, mm/s there, mm at its end, mm/s there
AT_ENDS = ((4.0, 5.0, 2.5, 11.0), (0.0, 0.0, 3.0, 4.0), ())
# the planner gets the hub; the first layer of the beads lies on the larger cone around it
STEEP_HUB, FLAT_HUB, SKIN_MM = Developable(60.0, 270.0), Developable(60.0, 60.0), 2.0
PROCESS = ProcessParameters(
    travel_speed=SPEED,
    bead_width=WIDTH,
    lead_on=0.5,
    lead_off=0.25,
    between_layers=BetweenLayersParameters(wait=2.5, input=3, call="clean", lift=LIFT),
)


@dataclasses.dataclass(frozen=True)
class Setup:
    """A cell and the cone on its platform, in part coordinates."""

    cell: CellParameters
    hub: Developable
    top: float
    most: float = math.pi  # rad, from the vertical


SETUPS = {
    "fanuc tool-on-robot": Setup(CellParameters(
        setup="tool-on-robot", mount="part", deposition_point=(1000.0, 0.0, -100.0, 0.0, 0.0, 0.0), limits="maker",
        branch=("front", "up", "flip"), nozzle=NozzleParameters(tool=(0.0, 0.0, 250.0, 0.0, 0.0, 0.0)),
    ), STEEP_HUB, 90.0),
    "fanuc positioner": Setup(CellParameters(
        setup="tool-on-robot", mount="part", limits="maker", branch="auto", platform=10.0, platform_diameter=100.0,
        external="motoman-motopos-d500 at 1000 60 -600 0 0 20 carries part",
        nozzle=NozzleParameters(tool=(0.0, 0.0, 250.0, 0.0, 0.0, 0.0)),
    ), FLAT_HUB, 50.0, math.radians(3.0)),
    "fanuc part-on-robot": Setup(CellParameters(mount="part", limits="paper"), FLAT_HUB, 50.0),
    "staubli tool-on-robot": Setup(CellParameters(
        machine="staubli-rx60bl", setup="tool-on-robot", mount="part", platform_diameter=100.0,
        deposition_point=(480.0, 0.0, -150.0, 0.0, 0.0, 0.0), nozzle=NozzleParameters(tool=(0.0, 0.0, 120.0, 0.0, 0.0, 0.0)),
    ), FLAT_HUB, 50.0),
    "staubli part-on-robot": Setup(CellParameters(
        machine="staubli-rx60bl", mount="part", platform_diameter=60.0,
        deposition_point=(300.0, 0.0, 300.0, np.pi, 0.0, 0.0),
    ), FLAT_HUB, 50.0),
    "ur part-on-robot": Setup(CellParameters(
        machine="ur-ur10e", mount="part", platform_diameter=60.0, deposition_point=(700.0, 0.0, 300.0, 0.0, 0.0, 0.0),
    ), FLAT_HUB, 50.0),
    "ur tool-on-robot": Setup(CellParameters(
        machine="ur-ur10e", setup="tool-on-robot", mount="part", platform_diameter=100.0,
        deposition_point=(700.0, 0.0, -100.0, 0.0, 0.0, 0.0), nozzle=NozzleParameters(tool=(0.0, 0.0, 150.0, 0.0, 0.0, 0.0)),
    ), FLAT_HUB, 50.0),
    "abb tool-on-robot": Setup(CellParameters(
        machine="abb-irb1600-6-12", setup="tool-on-robot", mount="part", platform_diameter=100.0,
        deposition_point=(800.0, 0.0, 100.0, 0.0, 0.0, 0.0), nozzle=NozzleParameters(tool=(0.0, 0.0, 150.0, 0.0, 0.0, 0.0)),
    ), FLAT_HUB, 50.0),
    "abb part-on-robot": Setup(CellParameters(
        machine="abb-irb1600-6-12", mount="part", platform_diameter=60.0,
        deposition_point=(700.0, 0.0, 600.0, np.pi, 0.0, 0.0),
    ), FLAT_HUB, 50.0),
    "yaskawa part-on-robot": Setup(CellParameters(
        machine="motoman-ma2010", mount="part", platform_diameter=60.0,
        deposition_point=(1000.0, 0.0, 300.0, 0.0, 0.0, 0.0),
    ), FLAT_HUB, 50.0),
    "yaskawa tool-on-robot": Setup(CellParameters(
        machine="motoman-ma2010", setup="tool-on-robot", mount="part", platform_diameter=100.0,
        deposition_point=(1000.0, 0.0, -300.0, 0.0, 0.0, 0.0),
        nozzle=NozzleParameters(tool=(0.0, 0.0, 250.0, 0.0, 0.0, 0.0)),
    ), FLAT_HUB, 50.0),
    "yaskawa positioner": Setup(CellParameters(
        machine="motoman-ma2010", setup="tool-on-robot", mount="part", platform=10.0, platform_diameter=100.0,
        external="motoman-motopos-d500 at 1100 60 -700 0 0 20 carries part", branch="auto",
        nozzle=NozzleParameters(tool=(0.0, 0.0, 250.0, 0.15, 0.2, 0.0)),
    ), FLAT_HUB, 50.0, math.radians(3.0)),
    "kuka tool-on-robot": Setup(CellParameters(
        machine="kuka-kr16-2", setup="tool-on-robot", mount="part", platform_diameter=100.0,
        deposition_point=(1050.0, 0.0, 200.0, 0.0, 0.0, 0.0), nozzle=NozzleParameters(tool=(0.0, 0.0, 150.0, 0.0, 0.0, 0.0)),
    ), FLAT_HUB, 50.0),
    "kuka positioner": Setup(CellParameters(
        machine="kuka-kr16-2", setup="tool-on-robot", mount="part", platform=10.0, platform_diameter=100.0,
        external="motoman-motopos-d500 at 1100 60 -100 0 0 20 carries part", branch="auto",
        nozzle=NozzleParameters(tool=(0.0, 0.0, 150.0, 0.0, 0.0, 0.0)),
    ), FLAT_HUB, 50.0, math.radians(3.0)),
    "abb positioner": Setup(CellParameters(
        machine="abb-irb1600-6-12", setup="tool-on-robot", mount="part", platform=10.0, platform_diameter=100.0,
        external="motoman-motopos-d500 at 850 60 -100 0 0 20 carries part", branch="auto",
        nozzle=NozzleParameters(tool=(0.0, 0.0, 150.0, 0.0, 0.0, 0.0)),
    ), FLAT_HUB, 50.0, math.radians(3.0)),
    "fanuc track": Setup(CellParameters(
        setup="tool-on-robot", mount="part", limits="maker", branch="auto", platform_diameter=100.0,
        external="kuka-kl100-2 at 0 0 -356 0 0 90 carries robot", deposition_point=(1000.0, 500.0, -100.0, 0.0, 0.0, 0.0),
        nozzle=NozzleParameters(tool=(0.0, 0.0, 250.0, 0.0, 0.0, 0.0)),
    ), FLAT_HUB, 50.0),
    "yaskawa track": Setup(CellParameters(
        machine="motoman-ma2010", setup="tool-on-robot", mount="part", platform_diameter=100.0, branch="auto",
        external="kuka-kl100-2 at 0 0 -356 0 0 90 carries robot", deposition_point=(1000.0, 500.0, -300.0, 0.0, 0.0, 0.0),
        nozzle=NozzleParameters(tool=(0.0, 0.0, 250.0, 0.0, 0.0, 0.0)),
    ), FLAT_HUB, 50.0),
    "fanuc track and positioner": Setup(CellParameters(
        setup="tool-on-robot", mount="part", limits="maker", branch="auto", platform=10.0, platform_diameter=100.0,
        external="motoman-motopos-d500 at 1000 560 -600 0 0 20 carries part; kuka-kl100-2 at 0 0 -356 0 0 90 carries robot",
        nozzle=NozzleParameters(tool=(0.0, 0.0, 250.0, 0.0, 0.0, 0.0)),
    ), FLAT_HUB, 50.0, math.radians(3.0)),
    "yaskawa track and positioner": Setup(CellParameters(
        machine="motoman-ma2010", setup="tool-on-robot", mount="part", platform=10.0, platform_diameter=100.0, branch="auto",
        external="motoman-motopos-d500 at 1100 560 -700 0 0 20 carries part; kuka-kl100-2 at 0 0 -356 0 0 90 carries robot",
        nozzle=NozzleParameters(tool=(0.0, 0.0, 250.0, 0.15, 0.2, 0.0)),
    ), FLAT_HUB, 50.0, math.radians(3.0)),
    "kuka track and positioner": Setup(CellParameters(
        machine="kuka-kr16-2", setup="tool-on-robot", mount="part", platform=10.0, platform_diameter=100.0, branch="auto",
        external="kuka-kl100-2 at 0 0 -356 0 0 90 carries robot; motoman-motopos-d500 at 1100 560 -100 0 0 20 carries part",
        nozzle=NozzleParameters(tool=(0.0, 0.0, 150.0, 0.0, 0.0, 0.0)),
    ), FLAT_HUB, 50.0, math.radians(3.0)),
    "abb track and positioner": Setup(CellParameters(
        machine="abb-irb1600-6-12", setup="tool-on-robot", mount="part", platform=10.0, platform_diameter=100.0,
        branch="auto",
        external="kuka-kl100-2 at 0 0 -356 0 0 90 carries robot; motoman-motopos-d500 at 850 560 -100 0 0 20 carries part",
        nozzle=NozzleParameters(tool=(0.0, 0.0, 150.0, 0.0, 0.0, 0.0)),
    ), FLAT_HUB, 50.0, math.radians(3.0)),
    "kuka track": Setup(CellParameters(
        machine="kuka-kr16-2", setup="tool-on-robot", mount="part", platform_diameter=100.0, branch="auto",
        external="kuka-kl100-2 at 0 0 -356 0 0 90 carries robot", deposition_point=(1050.0, 500.0, 200.0, 0.0, 0.0, 0.0),
        nozzle=NozzleParameters(tool=(0.0, 0.0, 150.0, 0.0, 0.0, 0.0)),
    ), FLAT_HUB, 50.0),
    "abb track": Setup(CellParameters(
        machine="abb-irb1600-6-12", setup="tool-on-robot", mount="part", platform_diameter=100.0, branch="auto",
        external="kuka-kl100-2 at 0 0 -356 0 0 90 carries robot", deposition_point=(800.0, 500.0, 100.0, 0.0, 0.0, 0.0),
        nozzle=NozzleParameters(tool=(0.0, 0.0, 150.0, 0.0, 0.0, 0.0)),
    ), FLAT_HUB, 50.0),
    "table": Setup(CellParameters(
        machine="table-xyzac", setup="rotary-table", platform=(10.0, -4.0, 30.0, 0.0, 0.0, 0.4), mount="part",
    ), STEEP_HUB, 90.0),
    "head": Setup(CellParameters(
        machine="head-table-xyzbc", setup="rotary-table", platform=(10.0, -4.0, 30.0, 0.0, 0.0, 0.4), mount="part",
    ), STEEP_HUB, 90.0),
}  # fmt: skip

PULSES = (1435.3, 1308.25, -1313.5, 980.0, 876.8125, 454.75, 1019.6875, -568.5, 81.92)
# post, motion, feed, set-up
WAYS = (
    ("fanuc", "joint", "time", "fanuc part-on-robot"), ("fanuc", "joint", "time", "fanuc tool-on-robot"),
    ("fanuc", "cartesian", "time", "fanuc tool-on-robot"), ("fanuc", "joint", "time", "fanuc positioner"),
    ("fanuc", "joint", "time", "fanuc track"), ("fanuc", "joint", "time", "fanuc track and positioner"),
    *(("staubli", motion, "time", f"staubli {setup}") for motion in ("joint", "cartesian")
      for setup in ("part-on-robot", "tool-on-robot")),
    ("ur", "joint", "time", "ur part-on-robot"), ("ur", "joint", "time", "ur tool-on-robot"),
    ("ur", "cartesian", "time", "ur tool-on-robot"),
    *(("abb", motion, "time", f"abb {setup}") for motion in ("joint", "cartesian")
      for setup in ("part-on-robot", "tool-on-robot", "positioner", "track", "track and positioner")),
    ("yaskawa", "joint", "time", "yaskawa part-on-robot"), ("yaskawa", "joint", "time", "yaskawa tool-on-robot"),
    ("yaskawa", "cartesian", "time", "yaskawa tool-on-robot"), ("yaskawa", "joint", "time", "yaskawa positioner"),
    ("yaskawa", "joint", "time", "yaskawa track"), ("yaskawa", "joint", "time", "yaskawa track and positioner"),
    ("kuka", "cartesian", "time", "kuka tool-on-robot"), ("kuka", "cartesian", "time", "kuka positioner"),
    ("kuka", "cartesian", "time", "kuka track"), ("kuka", "cartesian", "time", "kuka track and positioner"),
    *(("siemens", motion, feed, setup) for setup in ("table", "head")
      for motion, feed in (("joint", "time"), ("joint", "path"), ("cartesian", "time"))),
    *(("linuxcnc", motion, feed, "table") for motion, feed in (("joint", "time"), ("joint", "path"), ("cartesian", "time"))),
)  # fmt: skip


def _spanning():
    """Return names of variants that together cover each post with each motion and feed, each post
    with its external axes, and each set-up."""
    covered, names = set(), []
    for post, motion, feed, setup in reversed(WAYS):
        kind = setup.removeprefix(f"{post} ")
        new = {(post, motion, feed), kind} | (
            {(post, "external")} if "track" in kind or "positioner" in kind else set()
        )
        if not new <= covered:
            names.append(" ".join((post, motion, feed, setup)))
        covered |= new
    return names


SPANNING = _spanning()
ONE_OF_EACH = {variant[0]: " ".join(variant) for variant in WAYS}.values()  # one for each post


def _bead(hub, side, layer):
    """Return a short bead on one side, which runs along the cone and a little around it."""
    skin, share = hub.offset(SKIN_MM + HEIGHT * layer), np.linspace(0.0, 1.0, 9)
    theta, z = 2.0 * math.pi * side / SIDES + 0.3 * share, 12.0 + 18.0 * share
    rho = skin.radius * (1.0 - z / skin.height)
    points = np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=1)
    up = skin.normals(points)
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    return Bead(
        points,
        up,
        up,
        2.0 * math.pi * length / length[-1],
        np.full(len(points), SPEED),
        False,
        ends=BeadEnds(*AT_ENDS[side]) if AT_ENDS[side] else None,
    )


def wanted_speeds(side, along):
    """Return the speeds (n,) in mm/s of the segments of a bead between positions (n + 1,) in mm
    along it."""
    middle, speeds = 0.5 * (along[1:] + along[:-1]), np.full(len(along) - 1, SPEED)
    if AT_ENDS[side]:
        start_length, start_speed, end_length, end_speed = AT_ENDS[side]
        speeds[middle < start_length], speeds[middle > along[-1] - end_length] = (
            start_speed,
            end_speed,
        )
    return speeds


def body(setup):
    """Return the cone as triangles."""
    angle = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
    rings = [
        np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(48, z)], axis=1)
        for radius, z in (
            (setup.hub.radius, 0.0),
            (setup.hub.radius * (1.0 - setup.top / setup.hub.height), setup.top),
        )
    ]
    vertices = np.vstack([*rings, [[0.0, 0.0, 0.0], [0.0, 0.0, setup.top]]])
    low = np.arange(48)
    next_low, high, next_high = np.roll(low, -1), low + 48, np.roll(low, -1) + 48
    middle, top = np.full(48, 96), np.full(48, 97)
    sides = [
        (low, next_low, next_high),
        (low, next_high, high),
        (middle, next_low, low),
        (top, high, next_high),
    ]
    return Body("hub", vertices, np.concatenate([np.stack(corners, axis=1) for corners in sides]))


def _add_ramps(bead, start=0.0, end=0.0):
    ends = dataclasses.replace(bead.ends, start_ramp=start, end_ramp=end)
    return dataclasses.replace(bead, ends=ends)


@functools.cache
def planned(name, lift=LIFT, retreat=0.0, ramps=()):
    """Return the cell, beads and motion of a set-up. Without a retract distance all beads are on
    one side and stacked, so the straight path back to the next start leads through the last
    bead."""
    setup = SETUPS[name]
    cell = cells.resolve(setup.cell, np.eye(4), "developable")
    if name.startswith("yaskawa"):  # only a user's machine file states it, no real robot's
        cell = dataclasses.replace(
            cell,
            machine=dataclasses.replace(
                cell.machine, pulses_per_degree=PULSES[: cell.machine.chain.axes], speed_unit="mm/s"
            ),
        )
    sides = range(SIDES if lift else 1)
    beads = [[_bead(setup.hub, side, k) for side in sides] for k in range(2)]
    layers = tuple(
        Layer(
            tuple(bead if bead.ends is None else _add_ramps(bead, *ramps) for bead in layer_beads)
        )
        for layer_beads in beads
    )
    toolpath = Toolpath(
        layers,
        np.eye(4),
        HEIGHT,
        CHORD_ERROR,
        family="developable",
        rules=MotionRules(retreat=retreat, max_from_vertical=setup.most),
    )
    path = plan_joints(toolpath, cell, JointParameters(degree=1))
    assert path.feasible, [issue.message for issue in path.issues]
    process = dataclasses.replace(
        PROCESS, between_layers=dataclasses.replace(PROCESS.between_layers, lift=lift)
    )
    motion, issues = assemble(path, cell, process, [body(setup)], layer_height=HEIGHT)
    assert not has_errors(issues), [issue.message for issue in issues]
    return cell, [bead.bead for bead in path.beads], motion


@functools.cache
def write_program(variant, max_points=2000, lift=LIFT, retreat=0.0, ramps=()):
    """Return the cell, the motion, the program and its files."""
    post, kind, feed, name = variant
    cell, beads, motion = planned(name, lift, retreat, ramps)
    if post == "staubli" and kind == "cartesian" and cell.setup == "part-on-robot":
        motion = steps.refined_to_chord_error(motion, cell, CHORD_ERROR, beads)
    parameters = ProgramParameters(
        post=post, motion=kind, max_points=max_points, nc=NcParameters(feed=feed)
    )
    program = build(motion, cell, PROCESS, parameters, "job")
    return cell, motion, program, catalogue.load(post).write(program)
