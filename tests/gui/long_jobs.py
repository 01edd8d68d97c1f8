# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs that take minutes, for tests and for `bench`: a document, the macro function that computes,
and its inputs."""

from types import SimpleNamespace

import FreeCAD as App

from freecad_am import api


def sphere(document, angle=90):
    sphere_object = document.addObject("Part::Sphere", "Sphere")
    sphere_object.Radius, sphere_object.Angle1, sphere_object.Angle2 = 45, 0, angle
    document.recompute()
    return sphere_object


def revolution(root):
    """Return a job of a toolpath of a hemisphere with very thin layers."""
    document = App.newDocument("Long")
    feature = api.make_feature(document, sphere(document), layer_height=0.02, chord_error=0.0005)
    return SimpleNamespace(document=document, function="make_toolpath", inputs={"feature": feature})


def wall(root):
    """Return a job of a toolpath of a bend on a pipe with very thin layers."""
    document = App.newDocument("Long")
    pipe = document.addObject("Part::Cylinder", "Pipe")
    pipe.Radius, pipe.Height = 32, 160
    pipe.Placement = App.Placement(App.Vector(0, -80, 0), App.Rotation(App.Vector(1, 0, 0), -90))
    document.recompute()
    bend = api.open_part(document, str(root / "resources" / "examples" / "tube-on-pipe.step"))
    feature = api.make_surface_feature(document, bend, ["Face1"], pipe, layer_height=0.25)
    return SimpleNamespace(document=document, function="make_toolpath", inputs={"feature": feature})


def hub(root):
    """Return a job of a toolpath of blades on a cone with very thin layers."""
    document = App.newDocument("Long")
    cone = document.addObject("Part::Cone", "Hub")
    cone.Radius1, cone.Radius2, cone.Height = 40, 25, 60
    blade = document.addObject("Part::Box", "Blade")
    blade.Length, blade.Width, blade.Height = 30, 12, 24
    blade.Placement.Base = App.Vector(25, -6, 14)
    document.recompute()
    feature = api.make_developable_feature(
        document, blade, cone, layer_height=0.1, bead_spacing=0.5
    )
    return SimpleNamespace(document=document, function="make_toolpath", inputs={"feature": feature})


def joints(root, layer_height=0.15, chord_error=0.002):
    """Return a job of a joint path of a hemisphere with thin layers."""
    document = App.newDocument("Long")
    cell = api.make_cell(document, limits="paper")
    feature = api.make_feature(
        document, sphere(document), layer_height=layer_height, chord_error=chord_error
    )
    toolpath = api.make_toolpath(document, feature, cell)
    return SimpleNamespace(
        document=document, function="make_joint_path", inputs={"toolpath": toolpath, "cell": cell}
    )


def elbow(root):
    """Return a job of a wall whose first layer takes seconds, on a mesh of a hundred thousand
    triangles."""
    document = App.newDocument("Long")
    folder = root / "resources" / "examples" / "walls"
    bend, block = (
        api.open_part(document, str(folder / name)) for name in ("elbow.step", "elbow-block.step")
    )
    feature = api.make_surface_feature(document, bend, substrate=block, layer_height=0.6)
    return SimpleNamespace(document=document, function="make_toolpath", inputs={"feature": feature})


JOBS = (revolution, wall, hub, joints)
PREVIEWED = (wall, hub, elbow)  # jobs whose panels have a preview
