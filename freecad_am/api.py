# SPDX-License-Identifier: LGPL-2.1-or-later
"""The macro interface: every stage as a function on document objects.

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

Parameters are the keys of the job file with `_` for nested keys (`nozzle_half_angle`, `seam_step`): numbers are mm,
deg, mm/s and s, texts are quantities such as "360 mm/min", poses are six numbers x y z RX RY RZ. Each function is one
step of undo. Errors are `core.issues.InputError` and `InfeasibleError`; a function that raises leaves nothing behind.
What a function alone needs is imported when it is called: most of the time of a small job is imports.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import FreeCAD as App

from .core.geometry.curves.bead_curves import POINT_FILES
from .core.issues import AmError, InputError, Issue
from .core.kinematics import machine as machines
from .core.kinematics.proposed_cell import cell_of
from .core.one_thread import one_thread
from .core.parameters.build_direction import BuildDirectionParameters
from .core.parameters.cell import CellParameters
from .core.parameters.inspection import InspectionParameters
from .core.parameters.joints import JointParameters
from .core.parameters.process import ProcessParameters
from .core.parameters.program import ProgramParameters
from .core.parameters.strategy import (
    CladdingParameters,
    CurvesParameters,
    DevelopableParameters,
    RevolutionParameters,
    SolidParameters,
    SurfaceParameters,
)
from .core.planning.program import written_by
from .objects import stage as stages
from .objects import user_machines
from .objects.cell import Cell
from .objects.feature_kinds import proxy_of
from .objects.findings import issues_of
from .objects.job_group import grouped
from .objects.joint_path import JointPath
from .objects.naming import proposed_name
from .objects.program import Program
from .objects.progress import told_to
from .objects.revival import revive
from .objects.settings import given
from .objects.toolpath import Toolpath, own_process
from .posts import catalogue, written

__all__ = (
    "change", "export", "export_wires", "inspect", "issues", "make_all", "make_cam_path", "make_cell",
    "make_cladding_feature", "make_curves_feature",
    "make_developable_feature", "make_feature", "make_feature_of", "make_joint_path", "make_program", "make_solid_feature",
    "make_surface_feature", "make_toolpath", "make_trajectory", "open_part", "proposed_name", "recompute", "result",
    "stages_of", "told_to",
)


def make_cell(doc: Any, label: str = "Cell", *, parameters: CellParameters | None = None, **values: Any) -> Any:
    """A cell: machine, set-up, platform and nozzle. `am.make_cell(doc, machine="kuka-kr16-2", nozzle_length=80)`"""
    return _make(doc, Cell, "Cell", label, {}, [parameters], values)


def make_feature(
    doc: Any, source: Any, faces: Sequence[str] = (), label: str = "Feature", *, axis: Any = None,
    fixtures: Sequence[Any] = (), strategy: RevolutionParameters | None = None,
    build_direction: BuildDirectionParameters | None = None, **values: Any,
) -> Any:
    """A feature of revolution of an object with a shape, or of some of its faces.

    `am.make_feature(doc, doc.Revolve, ["Face1"], layer_height=1.5)`; axis: (object, "Edge1") where the shape has none.
    fixtures: objects, solids or meshes, that the nozzle must not touch.
    """
    links = {"Axis": axis, "Fixtures": list(fixtures)}
    return make_feature_of(doc, "revolution", source, faces, label=label, links=links,
                           parameters=[strategy, build_direction], values=values)


def make_feature_of(
    doc: Any, kind: str, source: Any, faces: Sequence[str] = (), *, label: str = "Feature",
    links: Mapping[str, Any] | None = None, parameters: Sequence[Any] = (), values: Mapping[str, Any] | None = None,
) -> Any:
    """A feature of any family, by its kind. links: by property name, of which those count that the family has; `StartEdges`
    and `BaseFaces` are names alone. parameters: dataclasses of its sections; values: single ones by key."""
    proxy = proxy_of(kind)
    known = {link.name for link in proxy.links}
    given_links = {"Source": _with_faces(source, faces), **(links or {})}
    for name, owner in (("StartEdges", source), ("BaseFaces", given_links.get("Substrate"))):
        names = list(given_links.get(name) or ())
        given_links[name] = (owner, names) if names else None
    start = given_links.get("StartFaces") or ()
    given_links["StartFaces"] = (source, list(start)) if start and not isinstance(start, tuple) else start or None
    chosen = {name: value for name, value in given_links.items() if name in known}
    return _make(doc, proxy, "Feature", label, chosen, parameters, dict(values or {}))


def make_surface_feature(
    doc: Any, source: Any, faces: Sequence[str] = (), substrate: Any = None, label: str = "Feature", *,
    start_edges: Sequence[str] = (), fixtures: Sequence[Any] = (), strategy: SurfaceParameters | None = None,
    build_direction: BuildDirectionParameters | None = None, **values: Any,
) -> Any:
    """A wall, of an object's faces, that grows on a solid or closed mesh, or from edges of its own (start_edges).

    `am.make_surface_feature(doc, doc.Bend, ["Face1"], doc.Pipe, layer_height=1.5)`; fixtures: objects, solids or meshes,
    that the nozzle must not touch either.
    """
    links = {"Substrate": substrate, "Fixtures": list(fixtures), "StartEdges": start_edges}
    return make_feature_of(doc, "surface", source, faces, label=label, links=links, parameters=[strategy, build_direction],
                           values=values)


def make_developable_feature(
    doc: Any, source: Any, substrate: Any = None, base_faces: Sequence[str] = (), label: str = "Feature", *,
    faces: Sequence[str] = (), further: Sequence[Any] = (), fixtures: Sequence[Any] = (),
    strategy: DevelopableParameters | None = None, build_direction: BuildDirectionParameters | None = None, **values: Any,
) -> Any:
    """Solids, or closed meshes, that grow on cylinders and cones of a hub (substrate), on the base_faces of it or on those
    that they are found to stand on. `am.make_developable_feature(doc, doc.Blades, doc.Spindle, layer_height=2.5)`

    faces: of the source itself, where hub and solids are one. further: more objects to deposit; fixtures: objects, solids
    or meshes, that the nozzle must not touch either. `base_radius=60, base_height=200` gives the base by numbers.
    """
    links = {
        "Substrate": substrate, "Further": list(further), "Fixtures": list(fixtures), "BaseFaces": base_faces,
    }
    return make_feature_of(doc, "developable", source, faces, label=label, links=links,
                           parameters=[strategy, build_direction], values=values)


def make_solid_feature(
    doc: Any, source: Any, substrate: Any = None, label: str = "Feature", *, further: Sequence[Any] = (),
    guide: Any = None, start_faces: Any = (), fixtures: Sequence[Any] = (), strategy: SolidParameters | None = None,
    build_direction: BuildDirectionParameters | None = None, **values: Any,
) -> Any:
    """Any solids, or closed meshes, deposited in plane layers. `am.make_solid_feature(doc, doc.Bracket, layer_height=2)`

    further: more objects to deposit; substrate: what they stand on, where that is no platform; guide: of layers="along", an
    object or (object, ["Edge1"]); start_faces: of layers="geodesic" and "offset", names of the source's faces, or (object,
    ["Face1"]), that the first layer lies on; fixtures: objects, solids or meshes, that the nozzle must not touch either.
    """
    links = {
        "Substrate": substrate, "Further": list(further), "Fixtures": list(fixtures),
        "Guide": guide if guide is None or isinstance(guide, tuple) else (guide, [""]),
        "StartFaces": start_faces,
    }
    return make_feature_of(doc, "solid", source, label=label, links=links, parameters=[strategy, build_direction],
                           values=values)


def make_curves_feature(
    doc: Any, source: Any, faces: Sequence[str] = (), substrate: Any = None, label: str = "Feature", *,
    fixtures: Sequence[Any] = (), strategy: CurvesParameters | None = None,
    build_direction: BuildDirectionParameters | None = None, **values: Any,
) -> Any:
    """Edges, a wire, a sketch, or a table of points that `open_part` has read, laid as beads as they are.

    `am.make_curves_feature(doc, doc.Sketch, repeat=3, layer_height=2)`; faces: names of faces whose normals are the
    directions, and of edges where not all are laid; substrate: what they are laid on.
    """
    return make_feature_of(doc, "curves", source, faces, label=label, parameters=[strategy, build_direction],
                           links={"Substrate": substrate, "Fixtures": list(fixtures)}, values=values)


def make_cladding_feature(
    doc: Any, source: Any, faces: Sequence[str] = (), substrate: Any = None, label: str = "Feature", *,
    fixtures: Sequence[Any] = (), strategy: CladdingParameters | None = None,
    build_direction: BuildDirectionParameters | None = None, **values: Any,
) -> Any:
    """Faces of an object, all of one that is no solid, covered with layers of beads along their normals.

    `am.make_cladding_feature(doc, doc.Die, ["Face3"], layers=2, layer_height=2, bead_spacing=4)`; substrate, fixtures: what
    else the nozzle must not touch.
    """
    return make_feature_of(doc, "cladding", source, faces, label=label, parameters=[strategy, build_direction],
                           links={"Substrate": substrate, "Fixtures": list(fixtures)}, values=values)


def make_toolpath(
    doc: Any, feature: Any, cell: Any = None, label: str = "Toolpath", *, further: Sequence[Any] = (),
    sequence: str = "feature", processes: Sequence[ProcessParameters] = (),
    process: ProcessParameters | None = None, **values: Any,
) -> Any:
    """Layers and beads of a feature; the cell gives the nozzle to keep clear. `am.make_toolpath(doc, doc.Feature)`

    further: features that are deposited after it in one go, `sequence="feature"` in this order or `sequence="height"` the
    lowest layer first; `processes` are those of each, where they differ in what a feature has of its own. A list as the
    feature stands for it and further ones.
    """
    if "bead_width" in values:  # it is meant, even where it is the default
        values.setdefault("fill_width", "bead_width")
    first, *more = [*feature, *further] if isinstance(feature, (list, tuple)) else [feature, *further]
    links: dict[str, Any] = {"Feature": first, "Cell": cell}
    if more:
        own = [own_process(one, process or ProcessParameters()) for one in processes]
        links = {**links, "Further": more, "Sequence": sequence, "FeatureProcess": own}
    return _make(doc, Toolpath, "Toolpath", label, links, [process], values)


def make_joint_path(
    doc: Any, toolpath: Any, cell: Any, label: str = "Joint path", *, joints: JointParameters | None = None,
    **values: Any,
) -> Any:
    """Joint values of a toolpath in a cell. `am.make_joint_path(doc, doc.Toolpath, doc.Cell, method="constant")`

    A sound job that cannot be carried out makes an object with the status 'infeasible' and its issues.
    """
    return _make(doc, JointPath, "JointPath", label, {"Toolpath": toolpath, "Cell": cell}, [joints], values)


def make_program(
    doc: Any, joint_path: Any, label: str = "Program", *, name: str = "", program: ProgramParameters | None = None,
    **values: Any,
) -> Any:
    """The controller's files of a joint path, read back and checked: `am.make_program(doc, joint_path)`"""
    links = {"JointPath": joint_path, "ProgramName": name or label}
    return _make(doc, Program, "Program", label, links, [program], values)


def inspect(
    doc: Any, planned: Any, file: str, label: str = "Inspection", *, inspection: InspectionParameters | None = None,
    **values: Any,
) -> Any:
    """Measured points (CSV, TXT, XYZ, ASC; vertices of STL, OBJ, PLY) against a feature, a toolpath, or an object with a
    shape or mesh: laid onto it, with deviations, sphericity and circularity.

    `am.inspect(doc, doc.Feature, "cmm.csv", probe_radius=1.5, tolerance=0.3, heights="15 25 35")`
    """
    from .objects.inspection import Inspection

    return _make(doc, Inspection, "Inspection", label, {"Planned": planned, "File": file}, [inspection], values)


@one_thread()
def make_all(
    doc: Any, source: Any, faces: Sequence[str] = (), *, kind: str = "revolution", layers: str = "", substrate: Any = None,
    further: Sequence[Any] = (), base_faces: Sequence[str] = (), name: str = "", machine: str = "", post: str = "",
    process: Mapping[str, Any] | None = None, then: Sequence[Mapping[str, Any]] = (), mend: float = 0.0,
) -> tuple[Any, ...]:
    """All stages of a part at their defaults, in one step and one group: (cell, feature, toolpath, joint path[, program]).

    kind: revolution, surface (a wall of the source's faces on the substrate), developable (source and further solids on
    the substrate, on its base_faces), solid (source and further solids, in plane layers unless `layers` says others) or
    curves (edges of the source, named in faces). mend: mm across of the largest hole of a mesh that is closed; 0 for the
    usual one. The program is for the machine's controller, in the words of `post` where
    it reads them; there is none when no post is known that writes joint motion of this set-up for it, or the joint path is
    infeasible. process: parameters of the toolpath by key. A robot other than the default one gets a deposition point and a
    branch that suit it; what reaches below the platform is put on it, where mounting it by the feature does that.
    `am.make_all(doc, doc.Pot)`

    then: features that are deposited after it, in this order and one program, each by its `source`, `kind`, `layers`,
    `faces`, `substrate`, `further`, `base_faces` and `mend`; they come after the feature in what is returned.
    `am.make_all(doc, doc.Hub, then=[{"source": doc.Fins, "kind": "developable", "substrate": doc.Hub}])`
    """
    chosen = cell_of(machine, user_machines.folders())
    with _one_step(doc, "New job"):
        made = [make_cell(doc, parameters=chosen)]
        first = {
            "source": source, "kind": kind, "layers": layers, "faces": faces, "substrate": substrate, "further": further,
            "base_faces": base_faces, "mend": mend,
        }
        features = [_feature_of_job(doc, one) for one in (first, *then)]
        try:
            toolpath = make_toolpath(doc, features, made[0], **(process or {}))
        except InputError as error:
            if error.code != "OFF_PLATFORM" or "mount: feature" not in error.message:
                raise
            change(made[0], mount="feature")  # what it says would help
            toolpath = make_toolpath(doc, features, made[0], **(process or {}))
        path = make_joint_path(doc, toolpath, made[0])
        made += [*features, toolpath, path]
        posts = written_by(machines.load(chosen.machine, user_machines.folders()))
        wanted = post or ProgramParameters().post
        post = wanted if posts is None or wanted in posts else next(
            iter(catalogue.fitting(posts, ProgramParameters().motion, chosen.setup)), "")
        if path.Status == "up to date" and post:
            made.append(make_program(doc, path, name=name or proposed_name(source.Label), post=post))
        grouped(doc, f"Job {source.Label}", made)
        return tuple(made)


def _feature_of_job(doc: Any, given_keys: Mapping[str, Any]) -> Any:
    """A feature at its defaults by the keys that `make_all` takes. InputError BAD_VALUE for another key."""
    known = ("source", "kind", "layers", "faces", "substrate", "further", "base_faces", "mend")
    wrong = [key for key in given_keys if key not in known]
    if wrong or "source" not in given_keys:
        told = ", ".join(wrong) or "no source"
        raise InputError("BAD_VALUE", "then", f"{told}: give source, and any of {', '.join(known[1:])}")
    links = {
        "Substrate": given_keys.get("substrate"), "Further": list(given_keys.get("further", ())),
        "BaseFaces": given_keys.get("base_faces", ()),
    }
    values = {key: given_keys[key] for key in ("layers", "mend") if given_keys.get(key)}
    return make_feature_of(
        doc, given_keys.get("kind", "revolution"), given_keys["source"], given_keys.get("faces", ()), links=links,
        values=values,
    )


def change(obj: Any, **values: Any) -> Any:
    """Change parameters or inputs of a stage as its `make_...` takes them, and renew it and what follows; the object.

    `am.change(doc.Feature, layer_height=2)`. An error of what follows is told in its own Status. An error of the stage
    itself is raised and takes the change back, in documents that keep undo steps (those of the window do).
    """
    proxy = _stage(obj)
    with _one_step(obj.Document, f"Edit {obj.Label}"):
        links = {link.key: link.name for link in proxy.links}
        if isinstance(proxy, Program):
            links["name"] = "ProgramName"
        if proxy.kind == "inspection":
            links["file"] = "File"
        if proxy.kind == "toolpath":
            links["sequence"] = "Sequence"
        if "source" in values:
            values["source"] = _with_faces(values["source"], values.pop("faces", ()))
        if "start_edges" in values:
            wall = values.get("source") or obj.Source
            values["start_edges"] = (wall[0], list(values["start_edges"])) if wall and values["start_edges"] else None
        if "base_faces" in values:
            hub = values.get("substrate") or obj.Substrate
            values["base_faces"] = (hub, list(values["base_faces"])) if hub and values["base_faces"] else None
        chosen = {links[key]: values.pop(key) for key in links if key in values}
        given(obj, proxy, [], values)
        for property_name, value in chosen.items():
            setattr(obj, property_name, value)
        _renew(obj)
        for follower in _in_order(obj.InListRecursive):
            with contextlib.suppress(AmError):
                _renew(follower)
    return obj


def recompute(target: Any, force: bool = False) -> None:
    """Renew a document, or a stage and its inputs, shapes and expressions too. Raises the first error met, at the end.

    force: compute even what fits its inputs. `am.recompute(doc)`
    """
    document = target if hasattr(target, "Objects") else target.Document
    with _one_step(document, "Recompute"):
        with stages.deferred():
            document.recompute()
        wanted = document.Objects if document is target else [target, *target.OutListRecursive]
        errors = []
        for obj in _in_order(wanted):
            try:
                _renew(obj, force)
            except AmError as error:
                errors.append(error)
    if errors:
        raise errors[0]


def result(obj: Any) -> Any:
    """What the core made: CellParameters, RevolvedWall or SurfaceWall, Toolpath, Planned (joint path and motion),
    Written (files), Inspected (measured points).

    `am.result(doc.Toolpath).layers[0].beads[0].points`; read from the document, nothing is computed.
    """
    return _stage(obj).value(obj)


def issues(obj: Any) -> tuple[Issue, ...]:
    """The findings about a stage. `[issue.message for issue in am.issues(doc.JointPath)]`"""
    _stage(obj)
    return issues_of(obj)


def stages_of(doc: Any, kind: str = "") -> list[Any]:
    """The stages of a document, inputs first; all, or those of a kind: `am.stages_of(doc, "program")`

    Those that a FreeCAD without the workbench has saved as plain objects are stages again.
    """
    revive(doc)
    return [obj for obj in _in_order(doc.Objects) if kind in ("", obj.Proxy.kind)]


@one_thread()
def export(program: Any, folder: str) -> list[str]:
    """Write the files of a program, or the figures of an inspection, into a folder, which is made; the paths.

    Parts that an earlier, longer program of this name has left there are removed. `am.export(doc.Program, "out")`
    """
    if _stage(program).kind == "inspection":
        from .objects.inspection import files_of_figures as files_of
    else:
        from .objects.program import files_of
    files = files_of(program)
    try:
        return written.write(folder, files)
    except OSError as error:
        message = f"{error.strerror or error}; choose a folder you can write to"
        raise InputError("NOT_WRITABLE", error.filename or folder, message) from None


@one_thread()
def export_wires(obj: Any, path: str, *, rapids: bool = False) -> str:
    """Write beads, and the rapid moves if wanted, of a toolpath, joint path or program as wires into a STEP or DXF file.

    `am.export_wires(doc.JointPath, "path.step", rapids=True)`
    """
    from .interop import export as interop

    return interop.write_wires(obj, path, rapids)


def export_cell(cell: Any, path: str) -> str:
    """Write a cell into a file of its own, which jobs name: `cell: my-cell.yaml`.

    `am.export_cell(doc.Cell, "my-cell.yaml")`
    """
    from .interop import export as interop

    return interop.write_cell(cell, path)


def export_waypoints(obj: Any, path: str) -> str:
    """Write the points of a toolpath, joint path or program as a table, as the commands write waypoints.csv.

    `am.export_waypoints(doc.JointPath, "waypoints.csv")`
    """
    from .interop import export as interop

    return interop.write_waypoints(obj, path)


@one_thread()
def export_report(obj: Any, path: str) -> str:
    """Write the report of a toolpath, joint path or program as a page, as the commands write report.html; the path.

    `am.export_report(doc.Program, "report.html")`
    """
    from .interop import export as interop
    from .report.of_document import reported

    return interop.write_page(path, reported(obj), obj.Label)


@one_thread()
def make_cam_path(obj: Any) -> Any:
    """The path of a toolpath, joint path or program as an object of the CAM workbench, to be inspected there; it does not
    follow changes. `am.make_cam_path(doc.JointPath)`"""
    from .interop import export as interop

    with _one_step(obj.Document, "CAM path"):
        return interop.add_cam_path(obj)


@one_thread()
def make_trajectory(obj: Any, *, tolerance: float = 0.1, turn: float = 2.0) -> Any:
    """The same as a trajectory of the Robot workbench, thinned: within `tolerance` mm and, for the tool axis, `turn` deg.

    `am.make_trajectory(doc.JointPath, tolerance=0.5)`
    """
    from .interop import export as interop

    with _one_step(obj.Document, "Trajectory"):
        return interop.add_trajectory(obj, tolerance, math.radians(turn))


def open_part(doc: Any, path: str, object: str = "", scale: float = 1.0) -> Any:
    """A part file as an object of the document: STEP, IGES, BREP, an object (Name or Label) of an FCStd file; or a mesh
    (STL, OBJ, 3MF): solids on a hub, or what a wall grows on or is kept clear of; or a table of points (CSV), G-code of a
    slicer or a toolpath of AdaOne (.ada3dp), which are laid as beads.

    scale: mm of one unit of an STL or OBJ file, which do not tell it. `am.open_part(doc, "cup.step")`
    """
    if path.lower().endswith(tuple(POINT_FILES)):
        from .objects.table_part import open_points

        with _one_step(doc, "Open part"):
            table = open_points(doc, path)
            table.purgeTouched()
        return table
    from .objects.part_file import part_shape

    shape, label = part_shape(path, object, scale)
    with _one_step(doc, "Open part"):
        is_mesh = hasattr(shape, "Topology")
        part = doc.addObject("Mesh::Feature" if is_mesh else "Part::Feature", "Part")
        part.Label = label
        setattr(part, "Mesh" if is_mesh else "Shape", shape)
        if is_mesh:
            part.addProperty("App::PropertyLength", "FileScale", "Part", "How long one unit of the file is.", 1)
            part.FileScale = scale
        part.purgeTouched()
    return part


def _make(
    doc: Any, proxy: type, name: str, label: str, links: dict[str, Any], parameters: Sequence[Any],
    values: dict[str, Any],
) -> Any:
    with _one_step(doc, f"Make {label}"):
        obj = doc.addObject("App::FeaturePython", name)
        try:
            stage = proxy(obj)
            obj.Label = label
            for property_name, value in links.items():
                if value is not None:
                    setattr(obj, property_name, value)
            given(obj, stage, parameters, values)
            for other in _in_order(obj.OutListRecursive):
                other.Proxy.renew(other)
            _renew(obj)
        except BaseException:
            doc.removeObject(obj.Name)
            raise
    return obj


def _with_faces(source: Any, faces: Sequence[str]) -> Any:
    return None if source is None else (source, list(faces))


def _renew(obj: Any, force: bool = False) -> None:
    obj.Proxy.renew(obj, force)
    obj.purgeTouched()


def _stage(obj: Any) -> stages.Stage:
    proxy = stages.stage_of(obj)
    if proxy is None:
        raise InputError("BAD_INPUT", getattr(obj, "Label", repr(obj)), "it is no stage of this workbench; choose one")
    return proxy


def _in_order(objects: Sequence[Any]) -> list[Any]:
    """The stages among objects, inputs first."""
    return sorted((obj for obj in objects if stages.stage_of(obj)), key=lambda obj: len(obj.OutListRecursive))


@contextlib.contextmanager
def _one_step(doc: Any, name: str) -> Iterator[None]:
    """One step of undo, taken back whole when it fails; part of the step that is open, if there is one."""
    if App.getActiveTransaction() or not doc.UndoMode:
        yield
        return
    doc.openTransaction(name)
    try:
        yield
    except BaseException:
        doc.abortTransaction()
        raise
    doc.commitTransaction()
