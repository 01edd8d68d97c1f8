# SPDX-License-Identifier: LGPL-2.1-or-later
"""All tolerances of collision checks, mm, with their reasons. No other file defines one.

The model approximates faces by triangles, beads by chords and links by drawn shapes. Nozzles, which
are known to pass, are reduced by the deviation. Links, whose contacts must not be missed, are
enlarged by it.
"""

ROUNDING = 1e-9  # depths up to this in closed forms are rounding errors
CONVERGED = 1e-6  # accuracy of iterated distances
FACES = 0.1  # deviation of body triangles from true faces; permitted nozzle depth on rapids
ABOVE_FACES = (
    2.0 * FACES
)  # removed from a nozzle above its substrate, whose faces may deviate to both sides
# added around links: links and bodies are both triangulated, and bead pieces are long
ABOUT_FACES = 2.0 * FACES
CHORD = 0.05  # deviation of beads from their curves; permitted nozzle depth on rapids
# permitted depth halfway between bead points, where directions are interpolated
HALFWAY = 0.1
ALONG = 1e-9  # rad; maximum angle between a nozzle's axis and a direction that counts as axial
