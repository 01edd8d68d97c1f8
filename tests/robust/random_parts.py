# SPDX-License-Identifier: LGPL-2.1-or-later
"""Random parts with random settings, and the distance of points from each by its own formula, or by
its triangles."""

import functools
import math

import FreeCAD
import numpy as np
import Part

from tests.robust import job_bases, mutations, triangles

UP = FreeCAD.Vector(0, 0, 1)
DEFLECTION = 0.02  # mm of triangles, where a part has no formula
ROUNDED = 0.021  # mm of deviation that the package allows for walls, besides the chord error


def write(chance, folder, machines):
    """Return a job, as values, of a part and perhaps a substrate that are written into `folder`,
    and a function that returns the largest excess of points (n, 3), in mm, over the deviation that
    the job allows."""
    size = chance.choices((1.0, 80.0, 1500.0), (1, 12, 2))[0] * 10 ** chance.uniform(-0.4, 0.4)
    job, shape, substrate, distance, margin = chance.choice(KINDS)(chance, size)
    placed = _placement(chance, size)
    job = {
        "part": _write(shape.transformed(placed.toMatrix(), True), folder, "part", chance),
        **job,
    }
    if substrate is not None:
        mesh = chance.random() < 0.25
        job["substrate"] = _write(
            substrate.transformed(placed.toMatrix(), True), folder, "substrate", chance, mesh
        )
    strategy = job["strategy"]
    strategy["layer_height"] = f"{size / chance.uniform(5.0, 14.0):.4g} mm"
    strategy["chord_error"] = (
        f"{min(10.0, max(1e-5, size * 10 ** chance.uniform(-4.0, -2.0))):.4g} mm"
    )
    if strategy["kind"] in FILLED:
        strategy["bead_spacing"] = f"{size / chance.uniform(5.0, 14.0):.4g} mm"
    if chance.random() < 0.5:
        sections = dict(chance.choice(machines))
        job["cell"], job["program"] = dict(sections["cell"]), dict(sections["program"])
    for _ in range(chance.randint(0, 4)):
        _set(job, chance)
    return job, functools.partial(_excess, job, distance, margin, placed)


def _set(job, chance):
    """Set one parameter to a plausible value."""
    key, spec, default = chance.choice(mutations.specs(job))
    section = key.split(".")[0]
    lengths = (
        "strategy.layer_height",
        "strategy.chord_error",
        "strategy.bead_spacing",
        "strategy.base.axis",
    )
    words = (
        spec.kind == "text"
        or key in ("cell.machine", "cell.setup", *lengths)
        or key.startswith("strategy.base")
    )
    if not words and (section in job or section in ("build_direction", "process")):
        mutations.put(job, key, mutations.valid_value(key, spec, default, chance))


def _excess(job, distance, margin, placed, points, build):
    """Return the largest excess of a point; distance: from the part at its own location, margin:
    allowed mm."""
    if not len(points):
        return 0.0
    inverse = np.array(placed.inverse().toMatrix().A).reshape(4, 4)
    high = (
        job_length(job["strategy"]["layer_height"]) if job["strategy"]["kind"] == "solid" else 0.0
    )
    shares = (
        (0.0, 0.5, 1.0) if high else (0.0,)
    )  # plane layers are cut at their bottom, middle or top
    cuts = [points + share * high * build for share in shares]
    farthest = np.min(
        [distance(cut @ inverse[:3, :3].T + inverse[:3, 3]) for cut in cuts], axis=0
    ).max()
    rounding = 1e-9 * np.abs(points).max() + 2e-6  # waypoints have six decimals
    return float(farthest) - margin(job) - rounding


def _is_on_wall(job):
    return float(job["strategy"]["chord_error"].split()[0]) + ROUNDED


def _placement(chance, size):
    """Return a placement: the identity, a rotation with a shift, or one far away."""
    distance = chance.choices((0.0, 1.0, 1e3), (5, 4, 1))[0] * size
    if not distance:
        return FreeCAD.Placement()
    axis = FreeCAD.Vector(*(chance.gauss(0.0, 1.0) for _ in range(3)))
    turned = FreeCAD.Rotation(axis, chance.uniform(0.0, 360.0))
    return FreeCAD.Placement(
        FreeCAD.Vector(*(distance * chance.gauss(0.0, 1.0) for _ in range(3))), turned
    )


# revolution
# ------------------------------------------------------------------------------------------------------------


def revolved(chance, size):
    """Return a meridian of lines or an arc, revolved about an axis: a shell, or a solid with a
    wall."""
    radius, tall = size * chance.uniform(0.1, 1.0), size * chance.uniform(0.3, 1.0)
    count = chance.randint(2, 5)
    corners = [(radius * chance.uniform(0.2, 1.0), tall * k / (count - 1)) for k in range(count)]
    if chance.random() < 0.15:
        corners[-1] = (0.0, corners[-1][1])  # closed at the top
    line = np.array(corners)
    if chance.random() < 0.4:
        bow = 0.5 * (line[0] + line[-1]) + np.array([size * chance.uniform(0.02, 0.3), 0.0])
        arc = Part.Arc(*(FreeCAD.Vector(r, 0, z) for r, z in (line[0], bow, line[-1])))
        edges, line = [arc.toShape()], np.array([(p.x, p.z) for p in arc.discretize(2000)])
    else:
        edges = Part.makePolygon([FreeCAD.Vector(r, 0, z) for r, z in line]).Edges
    thick = (
        size * 10 ** chance.uniform(-3.0, -1.0)
        if chance.random() < 0.5 and line[:, 0].min() > 0.0
        else 0.0
    )
    if thick:
        outer = [edge.translated(FreeCAD.Vector(thick, 0, 0)) for edge in edges]
        ends = [
            Part.makeLine(FreeCAD.Vector(r, 0, z), FreeCAD.Vector(r + thick, 0, z))
            for r, z in line[[0, -1]]
        ]
        wire = Part.Wire(Part.__sortEdges__([*edges, *outer, *ends]))
        shape = Part.Face(wire).revolve(FreeCAD.Vector(), UP, _turn(chance))
        shape = Part.Solid(shape.Shells[0]) if shape.ShapeType != "Solid" else shape
    else:
        shape = Part.Wire(edges).revolve(FreeCAD.Vector(), UP, _turn(chance))

    def distance(points):
        r = np.hypot(points[:, 0], points[:, 1])
        return np.min([_off_line(r - add, points[:, 2], line) for add in {0.0, thick}], axis=0)

    def margin(job):
        return _is_on_wall(job) + (thick if job["strategy"].get("wall") == "middle" else 0.0)

    return {"strategy": {"kind": "revolution"}}, shape, None, distance, margin


def _turn(chance):
    return 360.0 if chance.random() < 0.8 else chance.uniform(60.0, 340.0)


def _off_line(r, z, line):
    """Return distances of points (n,) from the straight segments of a line (k, 2)."""
    positions = np.stack([r, z], axis=-1)[:, None]
    along = np.diff(line, axis=0)
    share = ((positions - line[:-1]) * along).sum(2) / np.maximum((along**2).sum(1), 1e-300)
    return np.linalg.norm(
        line[:-1] + np.clip(share, 0.0, 1.0)[..., None] * along - positions, axis=2
    ).min(axis=1)


# tubes on parts
# --------------------------------------------------------------------------------------------------------


def tube(chance, size):
    """Return a cylinder or cone on a block, a rod or a ball, straight or leaning."""
    radius, tall = size * chance.uniform(0.1, 0.4), size * chance.uniform(0.4, 1.2)
    grows = chance.choice((0.0, 0.0, 0.3, -0.3))
    low, high = -0.3 * size, tall
    wide = radius * (1.0 + grows)
    narrow, start = radius * (1.0 - grows * 0.3 * size / tall), FreeCAD.Vector(0, 0, low)
    shape = (
        Part.makeCone(narrow, wide, high - low, start)
        if grows
        else Part.makeCylinder(radius, high - low, start)
    )
    wall = shape.Faces[0]
    slope = (wide - narrow) / (high - low)
    foot = _foot(chance, size, radius)
    cut = wall.cut(foot)
    faces = [face for face in cut.Faces if face.BoundBox.ZMax > 0.9 * high]

    def distance(points):
        r = np.hypot(points[:, 0], points[:, 1])
        return np.abs(r - radius - slope * points[:, 2]) / math.hypot(1.0, slope)

    return _surface(), faces[0] if faces else wall, foot, distance, _is_on_wall


def _foot(chance, size, radius):
    kind = chance.randrange(3)
    if kind == 0:
        return Part.makeBox(
            size, size, 0.5 * size, FreeCAD.Vector(-0.5 * size, -0.5 * size, -0.5 * size)
        )
    if kind == 1:
        wide = max(radius * chance.uniform(1.2, 3.0), 0.3 * size)
        return Part.makeCylinder(
            wide, 3 * size, FreeCAD.Vector(-1.5 * size, 0, -0.9 * wide), FreeCAD.Vector(1, 0, 0)
        )
    ball = max(radius * chance.uniform(1.3, 3.0), 0.3 * size)
    return Part.makeSphere(ball, FreeCAD.Vector(0, 0, -0.9 * ball))


def bend(chance, size):
    """Return a segment of a torus on a block."""
    big, small = size * chance.uniform(0.3, 1.0), size * chance.uniform(0.05, 0.35)
    torus = Part.Toroid()
    torus.MinorRadius = 1e-3  # the minor radius must never exceed the major one
    torus.MajorRadius, torus.MinorRadius = max(big, 1.05 * small), small
    torus.Center, torus.Axis = FreeCAD.Vector(-torus.MajorRadius, 0, 0), FreeCAD.Vector(0, -1, 0)
    shape = torus.toShape(
        0.0,
        math.radians(chance.choice((30.0, 90.0, 120.0, 150.0, 170.0, chance.uniform(10.0, 175.0)))),
    )
    foot = Part.makeBox(
        3 * small, 3 * small, small, FreeCAD.Vector(-1.5 * small, -1.5 * small, -small)
    )
    middle = torus.MajorRadius

    def distance(points):
        return np.abs(
            np.hypot(np.hypot(points[:, 0] + middle, points[:, 2]) - middle, points[:, 1]) - small
        )

    return _surface(), shape, foot, distance, _is_on_wall


def sheared(chance, size):
    """Return a circle swept along a slanted line, on a block or a ball."""
    radius, tall, lean = (
        size * chance.uniform(0.05, 0.3),
        size * chance.uniform(0.5, 1.2),
        chance.uniform(0.0, 1.2),
    )
    low = -0.3 * size
    circle = Part.makeCircle(radius, FreeCAD.Vector(lean * low, 0, low))
    wall = circle.extrude(FreeCAD.Vector(lean * (tall - low), 0, tall - low))
    foot = _foot(chance, size, radius)
    faces = [face for face in wall.cut(foot).Faces if face.BoundBox.ZMax > 0.9 * tall]

    def distance(points):
        r = np.hypot(points[:, 0] - lean * points[:, 2], points[:, 1])
        return np.abs(r - radius) / math.hypot(1.0, lean)  # a lower bound

    return _surface(), faces[0] if faces else wall, foot, distance, _is_on_wall


def lofted(chance, size):
    """Return a shell through a circle and ellipses, on a block."""
    wires = []
    for k in range(chance.randint(2, 4)):
        a, b = sorted((size * chance.uniform(0.1, 0.4) for _ in range(2)), reverse=True)
        ellipse = (
            Part.Ellipse(FreeCAD.Vector(), a, b) if k else Part.Circle(FreeCAD.Vector(), UP, a)
        ).toShape()
        shift = 0.05 * size * min(k, 1)
        centre = FreeCAD.Vector(
            shift * chance.gauss(0, 1), shift * chance.gauss(0, 1), 0.4 * size * k
        )
        leans = FreeCAD.Rotation(FreeCAD.Vector(1, 0, 0), chance.uniform(-10, 10) * min(k, 1))
        ellipse.Placement = FreeCAD.Placement(centre, leans)
        wires.append(Part.Wire([ellipse]))
    shape = Part.makeLoft(wires, False, chance.random() < 0.3)
    foot = Part.makeBox(
        size, size, 0.2 * size, FreeCAD.Vector(-0.5 * size, -0.5 * size, -0.2 * size)
    )
    facets = _facets(shape)
    return (
        _surface(),
        shape,
        foot,
        lambda points: triangles.distance(points, facets),
        lambda job: _is_on_wall(job) + DEFLECTION,
    )


def _surface():
    return {"strategy": {"kind": "surface"}}


# solids
# ----------------------------------------------------------------------------------------------------------------


def boxes_on_hub(chance, size):
    """Return boxes around a cylinder or cone, fused or side by side."""
    radius, tall = size * chance.uniform(0.3, 0.8), 2.0 * size
    top = radius * chance.uniform(0.4, 0.95)
    hub = (
        Part.makeCylinder(radius, tall)
        if chance.random() < 0.6
        else Part.makeCone(radius, top, tall)
    )
    solids = []
    for _ in range(chance.randint(1, 4)):
        wide, high = (size * 10 ** chance.uniform(-1.3, -0.2) for _ in range(2))
        box = Part.makeBox(radius + size * chance.uniform(0.1, 0.6), wide, high)
        box.translate(
            FreeCAD.Vector(0, -0.5 * box.BoundBox.YLength, size * chance.uniform(0.1, 1.2))
        )
        box.rotate(FreeCAD.Vector(), UP, chance.uniform(0.0, 360.0))
        solids.append(box)
    fused = solids[0].multiFuse(solids[1:]) if len(solids) > 1 else solids[0]
    remainder = Part.Compound(fused.cut(hub).Solids)
    facets = _facets(remainder)

    def distance(points):
        return np.where(triangles.inside(points, facets), 0.0, triangles.distance(points, facets))

    return {"strategy": {"kind": "developable"}}, remainder, hub, distance, _beside_solids


def _beside_solids(job):
    strategy = job["strategy"]
    widest = max(
        job_length(strategy["bead_spacing"]),
        job_length(job.get("process", {}).get("bead_width", 8.0)),
    )
    return 0.5 * widest + job_length(strategy.get("margin", 0.0)) + _is_on_wall(job) + DEFLECTION


def mixed(chance, size):
    """Return a shape of no family, or several solids."""
    things = [
        Part.makeBox(*(size * 10 ** chance.uniform(-2.0, 0.0) for _ in range(3))),
        Part.makeSphere(0.4 * size),
        Part.makeTorus(0.5 * size, 0.2 * size),
        Part.makeCylinder(0.3 * size, size).cut(Part.makeCylinder(0.2 * size, size)),
        Part.makeCone(0.5 * size, 0.1 * size, size),
        Part.makeBox(size, size, size).cut(Part.makeSphere(0.9 * size)),
    ]
    shapes = chance.sample(things, chance.randint(1, 3))
    for other_shape in shapes[1:]:
        other_shape.translate(
            FreeCAD.Vector(*(size * chance.choice((0.0, 0.5, 3.0)) for _ in range(3)))
        )
    shape = (
        shapes[0].multiFuse(shapes[1:])
        if len(shapes) > 1 and chance.random() < 0.5
        else Part.Compound(shapes)
    )
    kind = chance.choice(("revolution", "surface", "developable", "solid", "solid", "solid"))
    foot = None if kind in ("revolution", "solid") else _foot(chance, size, 0.2 * size)
    facets = _facets(shape)

    def margin(job):
        if kind in FILLED:
            return _beside_solids(job)
        return (
            _is_on_wall(job)
            + DEFLECTION
            + (size if job["strategy"].get("wall") == "middle" else 0.0)
        )

    def distance(points):
        off = triangles.distance(points, facets)
        return np.where(triangles.inside(points, facets), 0.0, off) if kind in FILLED else off

    return {"strategy": {"kind": kind}}, shape, foot, distance, margin


FILLED = ("developable", "solid")
KINDS = (
    revolved,
    revolved,
    tube,
    tube,
    bend,
    sheared,
    lofted,
    boxes_on_hub,
    boxes_on_hub,
    mixed,
    mixed,
)


def job_length(value):
    """Return a length in mm."""
    return float(str(value).split()[0])


def _facets(shape):
    size = shape.BoundBox.DiagonalLength
    vertices, facets = shape.tessellate(max(DEFLECTION, 2e-5 * size))
    return np.array([[tuple(vertices[k]) for k in facet] for facet in facets])


# files
# -----------------------------------------------------------------------------------------------------------------


def _write(shape, folder, name, chance, mesh=False):
    """Return the section of a job about a file of a shape, or of its triangles, which may be
    damaged."""
    if mesh:
        facets = _facets(shape)
        (folder / f"{name}.stl").write_text(
            _stl(_damaged(facets, chance) if chance.random() < 0.5 else facets)
        )
        return {"file": f"{name}.stl"}
    ending = chance.choice(("step", "step", "brep", "igs"))
    file = str(folder / f"{name}.{ending}")
    {"step": shape.exportStep, "brep": shape.exportBrep, "igs": shape.exportIges}[ending](file)
    return {"file": f"{name}.{ending}"}


def _damaged(facets, chance):
    """Return triangles with some missing, flipped, duplicated, shaken, without area or far away."""
    facets = facets.copy()
    indices = [chance.randrange(len(facets)) for _ in range(chance.randint(1, 4))]
    kind = chance.randrange(6)
    if kind == 0:
        return np.delete(facets, indices, axis=0)
    if kind == 1:
        facets[indices] = facets[indices][:, ::-1]
    elif kind == 2:
        return np.concatenate([facets, facets[indices]])
    elif kind == 3:
        facets += (
            1e-4
            * np.ptp(facets)
            * np.random.default_rng(chance.randrange(1000)).normal(size=facets.shape)
        )
    elif kind == 4:
        facets[indices, 1] = facets[indices, 0]
    else:
        facets[indices[0], 0] = 1e6
    return facets


def _stl(facets):
    lines = ["solid part"]
    for corners in facets:
        lines += [
            "facet normal 0 0 0",
            "outer loop",
            *("vertex {:.9g} {:.9g} {:.9g}".format(*corner) for corner in corners),
            "endloop",
            "endfacet",
        ]
    return "\n".join([*lines, "endsolid part", ""])


def machines(folder_):
    """Return the sections of cells and programs on which parts are planned. Sections that were
    duplicated for later families are left out, so that seeds still give the same parts."""
    later = ("cladding on", "features on", *job_bases.FAMILY_OPTIONS, "rail")
    return [
        job
        for name, job in job_bases.bases(folder_)
        if "cell" in job and "program" in job and not name.startswith(later)
    ]
