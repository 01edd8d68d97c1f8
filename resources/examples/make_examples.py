# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writes the parts of the examples beside this script (Chalvin 2020, eqs. 20 to 22; Chalvin 2019, eq. 1), in `walls`,
in `thruster` and `rotor` (after Dai 2020), a bracket, a Y, a hub with fins, a bent
pipe, a die and a rosette.

Each wall is a surface, so that the wall deposited has exactly the radius of the equation.
Run it in any Python that finds FreeCAD: python3 resources/examples/make_examples.py
"""

from __future__ import annotations

import bracket_part
import curves_parts
import die_part
import finned_hub_part
import parts_of_revolution
import rotor_parts
import shells_on_parts
import step_files
import thruster_parts
import tubes_on_pipes
import wye_part

WALLS = step_files.HERE / "walls"
THRUSTER = step_files.HERE / "thruster"
ROTOR = step_files.HERE / "rotor"
PLAIN = (
    parts_of_revolution.hemisphere,
    parts_of_revolution.laval_nozzle,
    parts_of_revolution.intake_funnel,
    tubes_on_pipes.tube_on_pipe,
    tubes_on_pipes.pipe,
    bracket_part.bracket,
    wye_part.wye,
    finned_hub_part.finned_hub,
    curves_parts.pipe_bend,
    die_part.die,
)
ON_PARTS = {
    "wide-tube-on-pipe": tubes_on_pipes.wide_tube_on_pipe,
    "skewed-bend": tubes_on_pipes.skewed_bend,
    "skewed-bend-rod": tubes_on_pipes.skewed_bend_pipe,
    "coque évasée": shells_on_parts.flared_shell,
    "dôme": shells_on_parts.dome,
    "spatial-pipe": shells_on_parts.spatial_pipe,
    "cone": shells_on_parts.cone,
    "elbow": shells_on_parts.elbow,
    "elbow-block": shells_on_parts.elbow_block,
    "half shell": shells_on_parts.half_shell,
    "half shell rod": shells_on_parts.half_shell_pipe,
    "branched-tube": shells_on_parts.branched_tube,
    "base-plate": shells_on_parts.base_plate,
}

if __name__ == "__main__":
    WALLS.mkdir(exist_ok=True)
    for make in PLAIN:
        step_files.write_step(step_files.HERE / f"{make.__name__.replace('_', '-')}.step", make())
    curves_parts.write_rosette()
    for name, make in ON_PARTS.items():
        step_files.write_step(WALLS / f"{name}.step", make())
    THRUSTER.mkdir(exist_ok=True)
    step_files.write_step(THRUSTER / "spindle.step", thruster_parts.spindle())
    thruster_parts.blades().exportBrep(str(THRUSTER / "blades.brep"))
    ROTOR.mkdir(exist_ok=True)
    step_files.write_step(ROTOR / "hub.step", rotor_parts.hub())
    rotor_parts.blades().exportBrep(str(ROTOR / "blades.brep"))
    step_files.write_stl(WALLS / "scanned-pipe.stl", tubes_on_pipes.pipe_mesh())
