# SPDX-License-Identifier: LGPL-2.1-or-later
"""Our side of `bench infill`, in a process of its own: STL files to toolpaths through the macro interface, timed.

`python infill_job.py JOBS.json`: a list of jobs with `mesh` (file), `beads` (file to write) and `strategy` (parameters by
key). The first job is done twice and counted once, so that imports drop out.
"""

from __future__ import annotations

import json
import resource
import sys
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent


def main(jobs_file: str) -> None:
    """Do the jobs of a file."""
    jobs = json.loads(Path(jobs_file).read_text(encoding="utf-8"))
    for job in (jobs[0], *jobs):
        start = _processor_time()
        toolpath = plan(job["mesh"], job["strategy"])
        seconds = _processor_time() - start
        save_beads(toolpath, seconds, job["beads"])


def plan(mesh: str, strategy: dict[str, Any]) -> Any:
    """The toolpath of a mesh file."""
    import FreeCAD as App
    import Mesh  # isort: skip  (after FreeCAD, it crashes before)

    from freecad_am import api

    doc = App.newDocument("Infill")
    try:
        source = doc.addObject("Mesh::Feature", "Part")
        source.Mesh = Mesh.Mesh(mesh)
        feature = api.make_solid_feature(doc, source, **strategy)
        return api.result(api.make_toolpath(doc, feature))
    finally:
        App.closeDocument(doc.Name)


def save_beads(toolpath: Any, seconds: float, file: str) -> None:
    """Write the beads of a toolpath as arrays: points, effective widths at points, and the number of points of each bead."""
    beads = [bead for _, _, bead in toolpath]
    nominal, height = toolpath.bead_width, toolpath.layer_height
    widths = [
        np.full(len(bead), nominal) * (1.0 if bead.height is None else bead.height / height)
        if bead.width is None
        else bead.width * (1.0 if bead.height is None else bead.height / height)
        for bead in beads
    ]
    np.savez(
        file,
        points=np.vstack([bead.points for bead in beads]),
        widths=np.concatenate(widths),
        counts=np.array([len(bead) for bead in beads]),
        seconds=seconds,
    )


def _processor_time() -> float:
    """Processor seconds of this process and of those that it has waited for."""
    usages = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    from freecad_am.batch import host

    host.find_freecad()
    main(sys.argv[1])
