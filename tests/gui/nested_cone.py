# SPDX-License-Identifier: LGPL-2.1-or-later
"""A cone of PartDesign in a moved and rotated part, as in assemblies."""

import FreeCAD as App


def nested_cone(document, origin, height):
    """Return the outer part with its origin at `origin`, and the body of a cone 40 mm wide at the
    bottom and 20 mm at the top."""
    outer = document.addObject("App::Part", "Outer")
    outer.Placement = App.Placement(origin, App.Rotation(App.Vector(1, 2, 3), 50))
    body = document.addObject("PartDesign::Body", "Body")
    outer.addObject(body)
    cone = document.addObject("PartDesign::AdditiveCone", "Cone")
    body.addObject(cone)
    cone.Radius1, cone.Radius2, cone.Height = 20, 10, height
    return outer, body
