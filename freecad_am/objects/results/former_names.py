# SPDX-License-Identifier: LGPL-2.1-or-later
"""Results in documents name modules of dataclasses: where those are now that documents of earlier versions name."""

MOVED = {
    ".core.geometry.clad_faces": ".core.geometry.walls.clad_faces",
    ".core.geometry.contour": ".core.geometry.curves.contour",
    ".core.geometry.curves": ".core.geometry.curves.bead_curves",
    ".core.geometry.guide": ".core.geometry.curves.guide",
    ".core.geometry.mesh": ".core.geometry.mesh.triangle_mesh",
    ".core.geometry.mesh_wall": ".core.geometry.walls.mesh_wall",
    ".core.geometry.outline": ".core.geometry.curves.outline",
    ".core.geometry.part_depths": ".core.geometry.walls.part_depths",
    ".core.geometry.patch": ".core.geometry.walls.patch",
    ".core.geometry.patch_wall": ".core.geometry.walls.patch_wall",
    ".core.geometry.profile": ".core.geometry.curves.profile",
    ".core.geometry.region": ".core.geometry.regions.region",
    ".core.geometry.solid_mesh": ".core.geometry.mesh.solid",
    ".core.geometry.strip": ".core.geometry.regions.strip",
    ".core.geometry.surface": ".core.geometry.walls.surface",
    ".core.geometry.surface_wall": ".core.geometry.walls.surface_wall",
    ".core.geometry.surroundings": ".core.geometry.obstacles",
}
