# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every tolerance of collision checks, mm, each with its reason. No other file defines one.

The model differs from reality: faces by their triangles, beads by their chords, links by their
drawn shapes. A solid that must not touch is made smaller by that much where it is known to pass
(nozzles), larger where no contact may be missed (links).
"""

ROUNDING = 1e-9  # of depth in closed forms, which is rounding
CONVERGED = 1e-6  # to which distances found by iteration are known
FACES = 0.1  # that triangles of bodies are off their true faces: what a nozzle may be deep in them on rapids
ABOVE_FACES = (
    2.0 * FACES
)  # removed from a nozzle over its substrate, whose faces may be off on both sides
ABOUT_FACES = (
    2.0 * FACES
)  # added about links: they and the bodies both are triangles, and beads are cut into long pieces
CHORD = 0.05  # to which beads follow their curves: what a nozzle may be deep in them on rapids
HALFWAY = (
    0.1  # of depth let pass halfway between points of a bead, where directions are interpolated
)
ALONG = 1e-9  # rad off a nozzle's axis, below which a direction is along it
