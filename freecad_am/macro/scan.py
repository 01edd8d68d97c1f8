# SPDX-License-Identifier: LGPL-2.1-or-later
"""Macro functions for exports, part files and substrate scans."""

from __future__ import annotations

import math
from typing import Any

from ..core.geometry.curves.bead_curves import POINT_FILES
from ..core.issues import InputError, Text
from ..core.one_thread import one_thread
from ..core.parameters.inspection import AUTO, BEST, NONE, InspectionParameters
from ..posts import own_programs
from .arguments import (
    checked_document,
    checked_number,
    checked_object,
    checked_stage,
    checked_target,
    checked_text,
    make_stage,
    named,
    one_step,
)


@one_thread()
def export(program: Any, folder: str) -> list[str]:
    """Write the files of a program, or the results of an inspection, into a folder.

    If an earlier program of the same name had more part files, the surplus files are removed.

    Parameters
    ----------
    program : App.DocumentObject
        The program or inspection.
    folder : str
        Path of the folder; created if missing.

    Returns
    -------
    list of str
        Paths of the written files.

    Raises
    ------
    InputError
        WRONG_KIND for any other stage, NOT_WRITABLE if the folder is not writable.

    Examples
    --------
    >>> am.export(doc.Program, "out")
    """
    folder = checked_target(folder, "folder")
    kind = checked_stage(program).kind
    if kind == "inspection":
        from ..objects.inspection import files_of_figures as files_of
    elif kind == "program":
        from ..objects.program import files_of
    else:
        raise InputError(
            "WRONG_KIND",
            program.Label,
            "the object is neither a program nor an inspection; choose a program or an inspection",
        )
    files = files_of(program)
    try:
        return own_programs.write(folder, files)
    except OSError as error:
        message = Text("{}; choose a writable folder", error.strerror or error)
        raise InputError("NOT_WRITABLE", error.filename or folder, message) from None


@one_thread()
def export_wires(obj: Any, path: str, *, rapids: bool = False) -> str:
    """Write beads as wires to a STEP or DXF file.

    Parameters
    ----------
    obj : App.DocumentObject
        A toolpath, joint path or program.
    path : str
        Path of the file.
    rapids : bool, optional
        Whether to write the rapid moves too.

    Returns
    -------
    str
        Path of the file.

    Raises
    ------
    InputError
        BAD_INPUT for any other object.

    Examples
    --------
    >>> am.export_wires(doc.JointPath, "path.step", rapids=True)
    """
    from .. import interop

    path = checked_target(path, "path")
    checked_stage(obj)
    return interop.write_wires(obj, path, rapids)


def export_cell(cell: Any, path: str) -> str:
    """Write a cell to a separate file that jobs can refer to: `cell: my-cell.yaml`.

    Parameters
    ----------
    cell : App.DocumentObject
        The cell.
    path : str
        Path of the file.

    Returns
    -------
    str
        Path of the file.

    Raises
    ------
    InputError
        BAD_INPUT for any other object.

    Examples
    --------
    >>> am.export_cell(doc.Cell, "my-cell.yaml")
    """
    from .. import interop

    path = checked_target(path, "path")
    checked_stage(cell)
    return interop.write_cell(cell, path)


def export_waypoints(obj: Any, path: str) -> str:
    """Write the points as a table, in the format of waypoints.csv.

    Parameters
    ----------
    obj : App.DocumentObject
        A toolpath, joint path or program.
    path : str
        Path of the file.

    Returns
    -------
    str
        Path of the file.

    Raises
    ------
    InputError
        BAD_INPUT for any other object.

    Examples
    --------
    >>> am.export_waypoints(doc.JointPath, "waypoints.csv")
    """
    from .. import interop

    path = checked_target(path, "path")
    checked_stage(obj)
    return interop.write_waypoints(obj, path)


def export_joint_trajectory(obj: Any, path: str) -> str:
    """Write a joint path as trajectory_msgs/JointTrajectory of ROS 2, in JSON.

    The file has the names of the axes, and for each point positions, velocities and the time from
    the start: rad, prismatic axes m. Waits are two equal points. Velocities are zero where the
    machine stops.

    Parameters
    ----------
    obj : App.DocumentObject
        A joint path or program.
    path : str
        Path of the file.

    Returns
    -------
    str
        Path of the file.

    Raises
    ------
    InputError
        BAD_INPUT for any other object.
    InfeasibleError
        INPUT_INFEASIBLE if the joint path is infeasible.

    Examples
    --------
    >>> am.export_joint_trajectory(doc.JointPath, "path.json")
    """
    from .. import interop

    path = checked_target(path, "path")
    checked_stage(obj)
    return interop.write_joint_trajectory(obj, path)


@one_thread()
def export_report(obj: Any, path: str) -> str:
    """Write the report as an HTML page, in the format of report.html.

    Parameters
    ----------
    obj : App.DocumentObject
        A toolpath, joint path or program.
    path : str
        Path of the file.

    Returns
    -------
    str
        Path of the file.

    Raises
    ------
    InputError
        BAD_INPUT for any other object.

    Examples
    --------
    >>> am.export_report(doc.Program, "report.html")
    """
    from .. import interop
    from ..report.of_document import reported

    path = checked_target(path, "path")
    checked_stage(obj)
    return interop.write_page(path, reported(obj), obj.Label)


@one_thread()
def make_cam_path(obj: Any) -> Any:
    """Make a CAM workbench path for inspection. The path does not follow later changes.

    Parameters
    ----------
    obj : App.DocumentObject
        A toolpath, joint path or program.

    Returns
    -------
    App.DocumentObject
        The path.

    Raises
    ------
    InputError
        BAD_INPUT for any other object.

    Examples
    --------
    >>> am.make_cam_path(doc.JointPath)
    """
    from .. import interop

    checked_stage(obj)
    with one_step(obj.Document, "CAM path"):
        return interop.add_cam_path(obj)


@one_thread()
def make_trajectory(obj: Any, *, tolerance: float = 0.1, turn: float = 2.0) -> Any:
    """Make a thinned Robot workbench trajectory. The trajectory does not follow later changes.

    Parameters
    ----------
    obj : App.DocumentObject
        A toolpath, joint path or program.
    tolerance : float, optional
        Maximum distance of a removed point from the trajectory, mm.
    turn : float, optional
        Maximum angle error of the tool axis at a removed point, degrees.

    Returns
    -------
    App.DocumentObject
        The trajectory.

    Raises
    ------
    InputError
        BAD_INPUT for any other object.

    Examples
    --------
    >>> am.make_trajectory(doc.JointPath, tolerance=0.5)
    """
    from .. import interop

    checked_stage(obj)
    tolerance, turn = checked_number(tolerance, "tolerance"), checked_number(turn, "turn")
    with one_step(obj.Document, "Trajectory"):
        return interop.add_trajectory(obj, tolerance, math.radians(turn))


def open_part(doc: Any, path: str, object: str = "", scale: float = 1.0) -> Any:
    """Open a part file as an object of the document.

    Supported files are STEP, IGES, BREP and objects in FCStd files. Meshes (STL, OBJ, 3MF) are
    accepted as solids on a hub, as the substrate of a wall, or as a body that the nozzle must not
    touch. Point tables (CSV), slicer G-code and AdaOne toolpaths (.ada3dp) are printed as beads.

    Parameters
    ----------
    doc : App.Document
        The document.
    path : str
        Path of the file.
    object : str, optional
        Name or Label of the object in an FCStd file.
    scale : float, optional
        Length of one unit of an STL or OBJ file, mm; these formats store no unit.

    Returns
    -------
    App.DocumentObject
        The object.

    Raises
    ------
    InputError
        If the file cannot be read.

    Examples
    --------
    >>> am.open_part(doc, "cup.step")
    """
    checked_document(doc)
    path = checked_target(path, "path")
    checked_text(object, "object")
    scale = checked_number(scale, "scale")
    if path.lower().endswith(tuple(POINT_FILES)):
        from ..objects.table_part import open_points

        with one_step(doc, "Open part"):
            table = open_points(doc, path)
            table.purgeTouched()
        return table
    from ..objects.shapes.part_file import add_part, part_content

    shape, label, issues = part_content(path, object, scale)
    with one_step(doc, "Open part"):
        part = add_part(doc, shape, label, issues)
        if hasattr(shape, "Topology"):
            part.addProperty(
                "App::PropertyLength", "FileScale", "Part", "Length of one unit of the file.", 1
            )
            part.FileScale = scale
        part.purgeTouched()
    return part


def array_element(array: Any, index: int) -> Any:
    """Return an element of a link array as an object that stages accept.

    If FreeCAD shows elements as objects (`ShowElement`, in Draft `ExpandArray`), return the
    element. Otherwise return a hidden link to the element, placed next to the array.

    Parameters
    ----------
    array : App.DocumentObject
        The link array.
    index : int
        Index of the element, from 0 as in FreeCAD's selection.

    Returns
    -------
    App.DocumentObject
        The element.

    Raises
    ------
    InputError
        BAD_INPUT if `index` is not an integer.

    Examples
    --------
    >>> am.make_solid_feature(doc, am.array_element(doc.Array, 1))
    """
    from ..objects.shapes.places import object_of

    checked_object(array, "array")
    if isinstance(index, bool) or not isinstance(index, int):
        raise InputError(
            "BAD_INPUT", "index", "{} is not a whole number; give a number such as 1", named(index)
        )
    with one_step(array.Document, "Element of array"):
        return object_of(array, index)


def make_scan(
    doc: Any,
    substrate: Any,
    file: str,
    label: str = "Scan",
    *,
    fit: str = AUTO,
    unit: str = AUTO,
    pairs: str = "",
    within: float = 5.0,
) -> Any:
    """Read scanned points from a file for `make_toolpath(..., scan=...)`.

    Parameters
    ----------
    doc : App.Document
        The document.
    substrate : App.DocumentObject
        The scanned object, with a shape or mesh.
    file : str
        File of points (CSV, TXT, XYZ, ASC), or a mesh (STL, OBJ, PLY) whose vertices are used.
    label : str, optional
        Label of the inspection.
    fit : str, optional
        "best" registers the points to the substrate. "none" leaves the points unchanged. "auto"
        leaves them unchanged if most points lie within `within` mm of the substrate.
    unit : str, optional
        Unit of the points; "auto" for the unit named in the file, else mm.
    pairs : str, optional
        Three or more measured points and their positions on the substrate, as in an
        inspection; replaces any other fit.
    within : float, optional
        Maximum distance between points and substrate, mm.

    Returns
    -------
    App.DocumentObject
        An inspection of the substrate.

    Raises
    ------
    InputError
        SCAN_UNIT, SCAN_OTHER, SCAN_AMBIGUOUS.

    Examples
    --------
    >>> am.make_scan(doc, doc.Plate, "plate.ply")
    """
    from ..core.inspection import planned, point_file, scan_heights
    from ..objects.inspection import Inspection
    from ..objects.shapes.bodies import snapshot_of

    checked_document(doc)
    checked_text(label, "label")
    file = checked_target(file, "file")
    for text, where in ((fit, "fit"), (unit, "unit"), (pairs, "pairs")):
        checked_text(text, where)
    within = checked_number(within, "within")
    InspectionParameters(unit=unit)
    body = snapshot_of(checked_object(substrate, "substrate", doc)).body()
    measured = point_file.read(file, unit)
    scan_heights.refuse_size(measured.points, measured.label, body)
    is_fitted = fit == BEST or (
        fit == AUTO
        and scan_heights.share_near(measured.points, body, within) < scan_heights.LEAST_ON_PART
    )
    if is_fitted and not pairs:
        motion = planned.align_scan(measured.points, body, measured.label)
        pairs = planned.as_pairs(motion, scan_heights.extent(body.vertices))
    values = {"fit": NONE, "unit": unit, "pairs": pairs}
    with one_step(doc, f"Make {label}"):
        inspection = make_stage(
            doc, Inspection, "Inspection", label, {"Planned": substrate, "File": file}, [], values
        )
        try:
            scan_heights.refuse_other(
                inspection.Proxy.value(inspection).points, measured.label, body, within
            )
        except InputError:
            doc.removeObject(inspection.Name)
            raise
    return inspection
