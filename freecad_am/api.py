# SPDX-License-Identifier: LGPL-2.1-or-later
"""Macro interface: functions that make, change and export the stages of a document.

    import FreeCAD as App
    import freecad_am.api as am

    doc = App.newDocument()
    part = am.open_part(doc, "hemisphere.step")
    cell = am.make_cell(doc, limits="paper")
    feature = am.make_feature(doc, part, layer_height=1)
    toolpath = am.make_toolpath(doc, feature, cell)
    joint_path = am.make_joint_path(doc, toolpath, cell)
    program = am.make_program(doc, joint_path, name="hemisphere")
    am.export(program, "out")

Parameters are the job file's keys, with `_` for nested keys (`nozzle_half_angle`, `seam_step`).
Numbers are in mm, deg, mm/s and s. Strings are quantities such as "360 mm/min". A pose is six
numbers, x y z RX RY RZ. Each function is one undo step. Functions raise `core.issues.InputError` or
`InfeasibleError`; a function that raises leaves the document unchanged. Functions import rarely
used modules when called, because imports dominate the run time of a small job.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

from .core.families.registry import DEFAULT_KIND
from .core.issues import InputError, Issue
from .core.kinematics.arrangement import OF_ROBOTS
from .core.kinematics.proposed_cell import cell_of
from .core.kinematics.urdf import cell as urdf_cell
from .core.kinematics.urdf import machine as urdf_machine
from .core.one_thread import one_thread
from .core.parameters.cell import CellParameters
from .core.parameters.field import unknown_choice
from .core.parameters.inspection import InspectionParameters
from .core.parameters.joints import JointParameters
from .core.parameters.process import ProcessParameters
from .core.parameters.program import ProgramParameters
from .core.parameters.scan import ScanParameters
from .macro.arguments import (
    checked_document,
    checked_job,
    checked_list,
    checked_path,
    checked_stage,
    checked_text,
    in_order,
    make_stage,
    one_step,
)
from .macro.changes import change, recompute
from .macro.features import (
    make_cladding_feature,
    make_curves_feature,
    make_developable_feature,
    make_feature,
    make_feature_of,
    make_solid_feature,
    make_surface_feature,
)
from .macro.scan import (
    array_element,
    export,
    export_cell,
    export_joint_trajectory,
    export_report,
    export_waypoints,
    export_wires,
    make_cam_path,
    make_scan,
    make_trajectory,
    open_part,
)
from .macro.suit import (
    in_vain,
    is_held_apart,
    on_platform,
    proposed_place,
    refuse_otherwise,
    suit,
    suit_path,
)
from .objects import user_machines
from .objects.cell import Cell
from .objects.checks.controllers import post_of, usual_motion
from .objects.fields.rows import proposed_name, taken_name
from .objects.job_group import grouped
from .objects.joint_path import JointPath
from .objects.program import Program
from .objects.results.findings import issues_of
from .objects.stage import revive
from .objects.toolpath import Toolpath, own_process
from .objects.work.progress import told_to

__all__ = (
    "array_element",
    "change",
    "export",
    "export_cell",
    "export_joint_trajectory",
    "export_report",
    "export_waypoints",
    "export_wires",
    "inspect",
    "issues",
    "make_all",
    "make_cam_path",
    "make_cell",
    "make_cladding_feature",
    "make_curves_feature",
    "make_developable_feature",
    "make_feature",
    "make_feature_of",
    "make_joint_path",
    "make_program",
    "make_scan",
    "make_solid_feature",
    "make_surface_feature",
    "make_toolpath",
    "make_trajectory",
    "open_part",
    "place",
    "proposed_name",
    "read_cell",
    "recompute",
    "result",
    "stages_of",
    "told_to",
)

STAGE_KINDS = ("cell", "feature", "toolpath", "joint path", "program", "inspection")


def make_cell(
    doc: Any, label: str = "Cell", *, parameters: CellParameters | None = None, **values: Any
) -> Any:
    """Make a cell: machine, setup, platform and nozzle.

    A robot other than the default robot gets a suitable deposition point and branch, as in a new
    job, unless `values` sets them.

    Parameters
    ----------
    doc : App.Document
        The document.
    label : str, optional
        Label of the cell.
    parameters : CellParameters or None, optional
        Complete cell parameters; None for the defaults.
    **values : Any
        Individual parameters by key. external="urdf" uses the robot, track and positioner of
        the machine's URDF.

    Returns
    -------
    App.DocumentObject
        The cell.

    Raises
    ------
    InputError
        If a value is invalid.

    Examples
    --------
    >>> am.make_cell(doc, machine="kuka-kr16-2", nozzle_length=80)
    """
    if values.get("external") == urdf_machine.WHOLE_CELL:
        values["machine"], values["external"] = urdf_cell.cell_values_of_machine(
            values.get("machine")
        )
    with one_step(doc, f"Make {checked_text(label, 'label')}"):
        cell = make_stage(doc, Cell, "Cell", label, {}, [parameters], values)
        if parameters is None:
            proposed_place(cell, values)
    return cell


def make_toolpath(
    doc: Any,
    feature: Any,
    cell: Any = None,
    label: str = "Toolpath",
    *,
    further: Sequence[Any] = (),
    sequence: str = "feature",
    processes: Sequence[ProcessParameters] = (),
    scan: Any = None,
    zones: Sequence[Any] = (),
    process: ProcessParameters | None = None,
    fitting: ScanParameters | None = None,
    **values: Any,
) -> Any:
    """Make the toolpath of one or more features: their layers and beads.

    Parameters
    ----------
    doc : App.Document
        The document.
    feature : App.DocumentObject or list
        The feature, or a list of features in print order.
    cell : App.DocumentObject, optional
        The cell; planning keeps its nozzle clear of the part.
    label : str, optional
        Label of the toolpath.
    further : sequence of Any, optional
        Features to print after `feature` in the same program.
    sequence : str, optional
        "feature" to print feature by feature, "height" to print the lowest layer first.
    processes : sequence of ProcessParameters, optional
        Process of each feature; only settings that differ from `process` take effect.
    scan : App.DocumentObject, optional
        Scan from `make_scan` to which the first layers are fitted.
    zones : sequence of App.DocumentObject, optional
        Closed solids and meshes that settings by place name.
    process : ProcessParameters or None, optional
        Complete process parameters; None for the defaults.
    fitting : ScanParameters or None, optional
        Complete parameters for fitting layers to the scan; None for the defaults.
    **values : Any
        Individual parameters by key.

    Returns
    -------
    App.DocumentObject
        The toolpath.

    Raises
    ------
    InputError
        If a value is invalid.

    Examples
    --------
    >>> am.make_toolpath(doc, doc.Feature)
    """
    if "bead_width" in values:  # an explicit bead width applies to the fill, even at its default
        values.setdefault("fill_width", "bead_width")
    features = list(feature) if isinstance(feature, (list, tuple)) else [feature]
    main, *later = [*(features or [None]), *checked_list(further, "further")]
    links: dict[str, Any] = {"Feature": main, "Cell": cell, "Scan": scan}
    if zones:
        links["Zones"] = checked_list(zones, "zones")
    if later:
        feature_processes = [
            own_process(entry, process or ProcessParameters())
            for entry in checked_list(processes, "processes")
        ]
        links = {
            **links,
            "Further": later,
            "Sequence": sequence,
            "FeatureProcess": feature_processes,
        }
    return make_stage(doc, Toolpath, "Toolpath", label, links, [process, fitting], values)


def make_joint_path(
    doc: Any,
    toolpath: Any,
    cell: Any,
    label: str = "Joint path",
    *,
    joints: JointParameters | None = None,
    **values: Any,
) -> Any:
    """Plan the joint path of a toolpath in a cell.

    Parameters
    ----------
    doc : App.Document
        The document.
    toolpath : App.DocumentObject
        The toolpath.
    cell : App.DocumentObject
        The cell.
    label : str, optional
        Label of the joint path.
    joints : JointParameters or None, optional
        Complete planning parameters; None for the defaults.
    **values : Any
        Individual parameters by key.

    Returns
    -------
    App.DocumentObject
        The joint path. If the job is valid but infeasible, its status is 'infeasible' and its
        issues give the reasons.

    Raises
    ------
    InputError
        If a value is invalid.

    Examples
    --------
    >>> am.make_joint_path(doc, doc.Toolpath, doc.Cell, method="constant")
    """
    return make_stage(
        doc, JointPath, "JointPath", label, {"Toolpath": toolpath, "Cell": cell}, [joints], values
    )


def make_program(
    doc: Any,
    joint_path: Any,
    label: str = "Program",
    *,
    name: str = "",
    program: ProgramParameters | None = None,
    **values: Any,
) -> Any:
    """Write the controller files of a joint path, read them back and verify them.

    Parameters
    ----------
    doc : App.Document
        The document.
    joint_path : App.DocumentObject
        The joint path.
    label : str, optional
        Label of the program.
    name : str, optional
        Program name on the controller; empty for the label.
    program : ProgramParameters or None, optional
        Complete program parameters; None for the defaults.
    **values : Any
        Individual parameters by key. Without `motion`, the post's motion type is used: joint
        motion if the post supports both types.

    Returns
    -------
    App.DocumentObject
        The program.

    Raises
    ------
    InputError
        If a value is invalid.

    Examples
    --------
    >>> am.make_program(doc, joint_path)
    """
    if program is None and "motion" not in values:
        values = {**values, **usual_motion(joint_path, values.get("post"))}
    links = {"JointPath": joint_path, "ProgramName": name or label}
    return make_stage(doc, Program, "Program", label, links, [program], values)


def inspect(
    doc: Any,
    planned: Any,
    file: str,
    label: str = "Inspection",
    *,
    inspection: InspectionParameters | None = None,
    **values: Any,
) -> Any:
    """Compare measured points with a nominal shape.

    Parameters
    ----------
    doc : App.Document
        The document.
    planned : App.DocumentObject
        A feature, a toolpath, or an object with a shape or mesh. The points are registered to
        this object.
    file : str
        File of points (CSV, TXT, XYZ, ASC), or a mesh (STL, OBJ, PLY) whose vertices are used.
    label : str, optional
        Label of the inspection.
    inspection : InspectionParameters or None, optional
        Complete inspection parameters; None for the defaults.
    **values : Any
        Individual parameters by key.

    Returns
    -------
    App.DocumentObject
        The inspection, with deviations, sphericity and circularity.

    Raises
    ------
    InputError
        If a value is invalid.

    Examples
    --------
    >>> am.inspect(
    ...     doc, doc.Feature, "cmm.csv", probe_radius=1.5, tolerance=0.3, heights="15 25 35"
    ... )
    """
    from .objects.inspection import Inspection

    links = {"Planned": planned, "File": checked_path(file, "file")}
    return make_stage(doc, Inspection, "Inspection", label, links, [inspection], values)


@one_thread()
def make_all(
    doc: Any,
    source: Any,
    faces: Sequence[str] = (),
    *,
    kind: str = DEFAULT_KIND,
    layers: str = "",
    substrate: Any = None,
    further: Sequence[Any] = (),
    base_faces: Sequence[str] = (),
    name: str = "",
    machine: str = "",
    cell: str = "",
    post: str = "",
    process: Mapping[str, Any] | None = None,
    then: Sequence[Mapping[str, Any]] = (),
    mend: float = 0.0,
    setup: str = "",
    max_from_vertical: Any = None,
    layers_otherwise: str = "",
    layer_height: Any = None,
    bead_spacing: Any = None,
    platform_diameter: Any = None,
) -> tuple[Any, ...]:
    """Make all stages of a part with default parameters, in one undo step and one group.

    A robot other than the default robot gets a suitable deposition point and branch; the branch
    changes if the job needs another branch. With `setup="tool-on-robot"`, the robot gets a
    positioner if the torch would lean more than max_from_vertical.

    Parameters
    ----------
    doc : App.Document
        The document.
    source : App.DocumentObject
        The part.
    faces : sequence of str, optional
        Names of the part's faces or edges; empty for all.
    kind : str, optional
        revolution, surface (wall on the substrate, from the source's faces), developable
        (source and further solids on base_faces of the substrate), solid (source and further
        solids) or curves (edges of the source, named in faces).
    layers : str, optional
        Layer kind of solids; empty for planes.
    substrate : App.DocumentObject, optional
        The object below the part.
    further : sequence of Any, optional
        More objects to print.
    base_faces : sequence of str, optional
        Hub faces on which solids grow; empty for the faces that the solids touch.
    name : str, optional
        Program name; empty for a proposed name.
    machine : str, optional
        Id or file of the machine; empty for the default machine.
    cell : str, optional
        Path of a saved cell, which replaces the machine.
    post : str, optional
        Post that writes the program, if the machine's controller reads its format; empty
        for the machine's default post.
    process : Mapping[str, Any] or None, optional
        Toolpath parameters by key.
    then : Sequence[Mapping[str, Any]], optional
        Features to print after the first feature, in this order and in the same program. Each
        has the keys of the first feature (`source`, `kind`, `layers`, `faces` ...).
    mend : float, optional
        Maximum diameter of a mesh hole to close, mm; 0 for the default.
    setup : str, optional
        Cell set-up; empty for the default set-up.
    max_from_vertical : float or str, optional
        Maximum angle between torch and vertical; None for the default.
    layers_otherwise : str, optional
        Layer kind to use if `layers` is infeasible.
    layer_height : float or str, optional
        Feature layer height; None for the default.
    bead_spacing : float or str, optional
        Bead spacing of solids and cladding; None for the default.
    platform_diameter : float or str, optional
        Platform diameter; None to fit the platform to the first layer.

    Returns
    -------
    tuple of App.DocumentObject
        Cell, feature, the features of `then`, toolpath, joint path and program. The program is
        missing if no post supports the set-up, or if the toolpath or joint path is infeasible.

    Raises
    ------
    InputError
        If a value is invalid.

    Examples
    --------
    >>> am.make_all(doc, doc.Pot, layer_height="2 mm")
    >>> fins = {"source": doc.Fins, "kind": "developable", "substrate": doc.Hub}
    >>> am.make_all(doc, doc.Hub, then=[fins])
    """
    process, then = checked_job(
        doc,
        source,
        process,
        then,
        mend,
        kind=kind,
        layers=layers,
        name=name,
        machine=machine,
        post=post,
        setup=setup,
        layers_otherwise=layers_otherwise,
    )
    cell_parameters = (
        read_cell(cell)
        if cell
        else cell_of(machine, user_machines.folders(), setup or OF_ROBOTS[0].setup)
    )
    refuse_otherwise(kind, layers_otherwise)
    first_feature = {
        "source": source,
        "kind": kind,
        "faces": faces,
        "substrate": substrate,
        "further": further,
        "base_faces": base_faces,
        "mend": mend,
        "max_from_vertical": max_from_vertical,
        "layer_height": layer_height,
        "bead_spacing": bead_spacing,
    }
    disc = {} if platform_diameter is None else {"platform_diameter": platform_diameter}

    def planned(layers: str) -> list[Any]:
        cell_object = make_cell(doc, parameters=cell_parameters, **disc)
        features = [
            _feature_of_job(doc, keywords)
            for keywords in ({**first_feature, "layers": layers}, *then)
        ]
        toolpath = on_platform(
            cell_object,
            features,
            lambda: make_toolpath(doc, features, cell_object, **process),
            sized=not cell and not disc,
        )
        path = (
            []
            if toolpath.Status == "infeasible"
            else [_suited_path(doc, toolpath, cell_object, setup, bool(cell))]
        )
        return [cell_object, *features, toolpath, *path]

    with one_step(doc, "New job"):
        objects = planned(layers)
        if in_vain(objects, layers_otherwise):
            objects = planned(layers_otherwise)
        post, motion = post_of(cell_parameters, post, user_machines.folders())
        if post and objects[-1].Proxy.kind == "joint path" and objects[-1].Status == "up to date":
            objects.append(
                make_program(
                    doc,
                    objects[-1],
                    name=name or taken_name(source.Label, post),
                    post=post,
                    motion=motion,
                )
            )
        grouped(doc, f"Job {source.Label}", objects)
        return tuple(objects)


def _suited_path(doc: Any, toolpath: Any, cell: Any, setup: str, saved: bool) -> Any:
    """Make the joint path of a new job. Adapt the cell to the job unless the cell was saved."""
    if setup or not (saved or is_held_apart(cell, toolpath)):
        suit(cell, toolpath)
    path = make_joint_path(doc, toolpath, cell)
    if path.Status == "infeasible" and not saved:
        suit_path(cell, toolpath, path)
    return path


def read_cell(file: str) -> CellParameters:
    """Read a cell file, as written by `export_cell` and named in jobs.

    Parameters
    ----------
    file : str
        Path of the cell file; paths inside the file are relative to its folder.

    Returns
    -------
    CellParameters
        The cell.

    Raises
    ------
    InputError
        If a key of the file is invalid.

    Examples
    --------
    >>> am.make_cell(doc, parameters=am.read_cell("my-cell.yaml"))
    """
    from .sections import cell as saved

    return saved.read_cell_file(os.path.abspath(checked_path(file, "cell")).strip())


def _feature_of_job(doc: Any, given_keys: Mapping[str, Any]) -> Any:
    """Make a feature with default parameters from the keys that `make_all` takes.

    Raises InputError BAD_VALUE for any other key.
    """
    allowed = (
        "source",
        "kind",
        "layers",
        "faces",
        "substrate",
        "further",
        "base_faces",
        "mend",
        "max_from_vertical",
        "layer_height",
        "bead_spacing",
    )
    wrong = [key for key in given_keys if key not in allowed]
    if wrong or "source" not in given_keys:
        text = ", ".join(wrong) or "no source"
        raise InputError(
            "BAD_VALUE", "then", "{}: give source, and any of {}", text, ", ".join(allowed[1:])
        )
    links = {
        "Substrate": given_keys.get("substrate"),
        "Further": given_keys.get("further", ()),
        "BaseFaces": given_keys.get("base_faces", ()),
    }
    values = {key: given_keys[key] for key in ("layers", "mend") if given_keys.get(key)}
    for key in ("max_from_vertical", "layer_height", "bead_spacing"):
        if given_keys.get(key) is not None:
            values[key] = given_keys[key]
    return make_feature_of(
        doc,
        given_keys.get("kind", DEFAULT_KIND),
        given_keys["source"],
        given_keys.get("faces", ()),
        links=links,
        values=values,
    )


@one_thread()
def place(path: Any, cell: Any = None, *, parameters: Any = None, **values: Any) -> Any:
    """Search for part poses for a joint path or toolpath, in its own cell or another cell.

    The candidate poses form a box about the current pose. Each candidate is rated by the fraction
    of points that the machine can reach, the minimum margin, the time and the arm clearance. The
    document does not change.

    Parameters
    ----------
    path : App.DocumentObject
        The joint path or toolpath.
    cell : App.DocumentObject, optional
        Another cell; None for the cell of `path`.
    parameters : PlaceParameters, optional
        Complete placement parameters; None for the defaults.
    **values : Any
        Individual parameters by key, as in the job section `place`.

    Returns
    -------
    core.placement.place.Placed
        The rated poses; `best` is None if no pose is feasible.

    Raises
    ------
    InputError
        WRONG_KIND if `cell` is not a cell.

    Examples
    --------
    >>> found = am.place(doc.JointPath, x=300, step=100)
    >>> am.change(doc.Cell, **found.entries(found.best))
    """
    from .objects.checks.placed import change_parameters, placing_of

    checked_stage(path)
    if cell is not None and checked_stage(cell).kind != "cell":
        raise InputError("WRONG_KIND", cell.Label, "the object is not a cell; choose a cell")
    return placing_of(path, cell).search_poses(change_parameters(parameters, values))


def result(obj: Any) -> Any:
    """Return the stored result of a stage, without computing it.

    Parameters
    ----------
    obj : App.DocumentObject
        The stage.

    Returns
    -------
    object
        CellParameters, RevolvedWall or SurfaceWall, Toolpath, Planned (joint path and
        motion), Written (files) or Inspected (measured points).

    Raises
    ------
    InputError
        BAD_INPUT for any other object.

    Examples
    --------
    >>> am.result(doc.Toolpath).layers[0].beads[0].points
    """
    return checked_stage(obj).value(obj)


def issues(obj: Any) -> tuple[Issue, ...]:
    """Return the issues of a stage.

    Parameters
    ----------
    obj : App.DocumentObject
        The stage.

    Returns
    -------
    tuple of Issue
        Errors, warnings and notes.

    Raises
    ------
    InputError
        BAD_INPUT for any other object.

    Examples
    --------
    >>> [issue.message for issue in am.issues(doc.JointPath)]
    """
    checked_stage(obj)
    return issues_of(obj)


def stages_of(doc: Any, kind: str = "") -> list[Any]:
    """Return the stages of a document, inputs before dependent stages.

    If FreeCAD saved stages as plain objects because the workbench was missing, restore them.

    Parameters
    ----------
    doc : App.Document
        The document.
    kind : str, optional
        Stage kind to return; empty for all.

    Returns
    -------
    list of App.DocumentObject
        The stages.

    Raises
    ------
    InputError
        BAD_VALUE for an unknown kind.

    Examples
    --------
    >>> am.stages_of(doc, "program")
    """
    revive(checked_document(doc))
    if checked_text(kind, "kind") not in ("", *STAGE_KINDS):
        raise unknown_choice("kind", kind, STAGE_KINDS)
    return [obj for obj in in_order(doc.Objects) if kind in ("", obj.Proxy.kind)]
