# SPDX-License-Identifier: LGPL-2.1-or-later
"""A cone of PartDesign within a part that is moved and turned, as assemblies have them."""

import FreeCAD as App


def nested_cone(document, place, height):
    """The outer part, whose origin is at `place`, and the body of a cone 40 mm wide below, 20 mm above."""
    outer = document.addObject("App::Part", "Outer")
    outer.Placement = App.Placement(place, App.Rotation(App.Vector(1, 2, 3), 50))
    body = document.addObject("PartDesign::Body", "Body")
    outer.addObject(body)
    cone = document.addObject("PartDesign::AdditiveCone", "Cone")
    body.addObject(cone)
    cone.Radius1, cone.Radius2, cone.Height = 20, 10, height
    return outer, body
