# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machines from data files: geometry, limits and controller conventions, with check poses.

A machine file lists check poses: joint vectors with their flange poses. Each time a file is read,
the joint frames and the closed form compute these poses. A file that fails the check is rejected.
"""

from __future__ import annotations

import difflib
import functools
import json
import math
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ...geometry.job_files import is_there, locate
from ...issues import InputError, Text
from ...types import Array, ArrayLike, Mask
from ..arrangement import OF_FIVE_AXES, OF_ROBOTS, Arrangement
from ..chain import Chain
from ..inverse.five_axis import is_five_axis
from ..inverse.parallel_axes import ParallelAxesArm
from ..inverse.recognition import CalibratedArm
from ..inverse.serial_arm import SerialArm
from ..inverse.spherical_wrist import OpwArm
from ..limits import Limits, Payload
from ..links.bodies import LinkShape, Pieces, link_bodies, link_shapes
from ..urdf import machine as urdf_machine
from ..urdf.read import Description
from ..urdf.reference import reference
from . import calibration, file
from .file import Node, read


def unknown(name: str, names: Sequence[str]) -> InputError:
    """Return the error UNKNOWN_MACHINE, with similar known names."""
    return InputError(
        "UNKNOWN_MACHINE", "cell.machine", "unknown name {!r}; {}", name, _near(name, names)
    )


def _near(name: str, names: Sequence[str]) -> str:
    """Return the most similar names, or one name per manufacturer if no name is similar."""
    alike = difflib.get_close_matches(name.lower().replace("_", "-"), names, n=3, cutoff=0.5)
    if alike:
        return Text("did you mean {}?", ", ".join(alike))
    of_makers = {
        name_of_maker.partition("-")[0]: name_of_maker for name_of_maker in reversed(names)
    }
    return Text(
        "none of {} machines has a similar name; use a name that `freecad-am machines` lists, "
        "such as {}, or the path of a machine file or URDF",
        len(names),
        ", ".join(sorted(of_makers.values())),
    )


BUILT_IN = Path(__file__).resolve().parents[3] / "machines"
MAKER = "maker"
# a remark in old machine files, which have no `warnings`
BASE_NOT_KNOWN = "The maker's own base frame is not known: base_link is used in its place."
UNKNOWN_REMARK = "a URDF does not define the values shown by the controller"
REFUSED = (
    "BAD_MACHINE: "  # prefix of the text in place of the title of a file that is not a machine file
)
KEYS = (
    "id",
    "title",
    "sources",
    "remarks",
    "warnings",
    "joints",
    "flange",
    "base",
    "opw",
    "controller",
    "limits",
    "reach",
    "payload",
    "verified",
    "check_poses",
    "shapes",
    "bodies",
)


@dataclass(frozen=True, eq=False)
class Machine:
    """A machine. Serial joint values are in rad, or mm for prismatic joints; lengths are in mm.

    chain: from the floor plate, base_link. arm: inverse of a robot; None for a five-axis machine,
    and for an arm that cannot be planned, for which `no_arm` gives the reason. base: (4, 4)
    manufacturer's base frame in base_link. max_speed, max_acceleration, max_jerk: (axes,) rad or mm
    per s, s^2, s^3; infinite if unknown. controller_matrix C (axes, axes), controller_offset c0
    (axes,): the controller shows C q + c0. controller_remark: how certain this is. posts: posts
    that the controller can read; None if the file does not say. pulses_per_degree: (axes,).
    speed_unit: unit of path speeds. Both are empty if unknown. shapes: (axes + 1) link drawing
    files, base first. external: number of external axes, which come last (`external.coupled`).
    bodies: (axes + 1) bodies of the links. of_urdf: whether the machine comes from a URDF.
    warnings: doubts that may change a program.
    """

    id: str
    title: str
    axes: tuple[str, ...]
    chain: Chain
    arm: SerialArm | None
    no_arm: str
    base: Array
    max_speed: Array
    limit_sets: dict[str, Limits]
    controller_matrix: Array
    controller_offset: Array
    controller_remark: str
    posts: tuple[str, ...] | None
    pulses_per_degree: tuple[float, ...]
    speed_unit: str
    sources: tuple[str, ...]
    remarks: tuple[str, ...]
    max_acceleration: Array
    max_jerk: Array
    shapes: tuple[LinkShape | None, ...]
    external: int = 0
    payload: Payload = Payload()
    bodies: tuple[Pieces, ...] = ()
    of_urdf: bool = False
    warnings: tuple[file.MachineWarning, ...] = ()

    @property
    def opw(self) -> OpwArm | None:
        """The closed form of a spherical wrist arm; None for another arm."""
        return self.arm if isinstance(self.arm, OpwArm) else None

    @property
    def arrangements(self) -> tuple[Arrangement, ...]:
        """The set-ups that the machine supports, the most common first."""
        return (
            OF_FIVE_AXES
            if is_five_axis(self.chain.sliding[: len(self.axes) - self.external])
            else OF_ROBOTS
        )

    @property
    def free(self) -> int:
        """Number of coordinates that point and tool axis leave free.

        These are a robot's rotation about the tool axis, and external axes.
        """
        return self.arrangements[0].free + self.external

    @property
    def columns(self) -> tuple[str, ...]:
        """Axis names in tables: q1 to q6 for every robot, so that readers need no machine file."""
        if self.arrangements[0].named_axes:
            return self.axes
        robot_axes = len(self.axes) - self.external
        return (*(f"q{index + 1}" for index in range(robot_axes)), *self.axes[robot_axes:])

    @property
    def base_is_known(self) -> bool:
        """Whether `base` is the manufacturer's base frame; otherwise base_link replaces it."""
        return BASE_NOT_KNOWN not in self.remarks and not self.warnings_of("base")

    def warnings_of(self, *applies_to: str) -> tuple[str, ...]:
        """Return the warnings with these scopes, see entries.WARNED."""
        return tuple(warning.text for warning in self.warnings if warning.applies_to in applies_to)

    @property
    def units(self) -> tuple[str, ...]:
        """The displayed unit of each axis, 'deg' or 'mm'."""
        return tuple("mm" if sliding else "deg" for sliding in self.chain.sliding)

    @property
    def unit_values(self) -> Array:
        """Return the internal value of one displayed unit, for each axis.

        Returns
        -------
        (axes,) array
            rad per degree, or 1 per mm.
        """
        return unit_values(self.chain.sliding)

    def limits(self, name: str) -> Limits:
        """Return the limit set of this name. Raises InputError UNKNOWN_LIMITS if it is missing."""
        if name not in self.limit_sets:
            raise InputError(
                "UNKNOWN_LIMITS",
                "cell.limits",
                "{} has no set of limits {!r}; use {}",
                self.id,
                name,
                ", ".join(self.limit_sets),
            )
        return self.limit_sets[name]

    def to_controller(self, q: ArrayLike) -> Array:
        """Convert serial joint values to controller joint values.

        Parameters
        ----------
        q : (..., axes) array
            Serial values, rad or mm.

        Returns
        -------
        (..., axes) array
            Controller joint values, rad or mm.
        """
        result: Array = np.asarray(q, float) @ self.controller_matrix.T + self.controller_offset
        return result

    def from_controller(self, displayed: ArrayLike) -> Array:
        """Convert controller joint values to serial joint values.

        Parameters
        ----------
        displayed : (..., axes) array
            Controller joint values, rad or mm.

        Returns
        -------
        (..., axes) array
            Serial values, rad or mm.
        """
        back = np.linalg.inv(self.controller_matrix)
        result: Array = (np.asarray(displayed, float) - self.controller_offset) @ back.T
        return result


def unit_values(sliding: Mask) -> Array:
    """Return the internal value of one displayed unit, for each axis.

    Parameters
    ----------
    sliding : (axes,) bool array
        Prismatic axes.

    Returns
    -------
    (axes,) array
        rad per degree, or 1 per mm.
    """
    return np.where(sliding, 1.0, math.radians(1.0))


def known(folders: Sequence[Path | str] = ()) -> list[tuple[str, str]]:
    """Return all machines, built in and in the user's folders, sorted by id.

    An invalid file is listed with its error as the title; only `load` rejects it.

    Parameters
    ----------
    folders : Sequence[Path or str], optional
        Folders with user machines.

    Returns
    -------
    list[tuple[str, str]]
        Id and title of each machine.
    """
    return [(name, _title(path)) for name, path in sorted(_files(folders).items())]


def _title(path: Path) -> str:
    try:
        return read(path)["title"].text()
    except InputError as error:
        return f"{REFUSED}{error.message}"


def load(name: str | Path, folders: Sequence[Path | str] = ()) -> Machine:
    """Return the machine of an id, a machine file path, or a URDF (`urdf_machine.Reference`).

    A machine file name may include the calibration of one robot (`calibration.Named`). A file in
    the user's `folders` takes precedence over a built-in one.

    Raises InputError: UNKNOWN_MACHINE if the machine does not exist; BAD_MACHINE with file, key
    and value if the file is invalid or fails its check poses; BAD_CALIBRATION; BAD_URDF; and
    NO_CLOSED_FORM with the reason.
    """
    text = str(name)
    measured = calibration.named(text)
    if measured is not None:
        return _calibrated(load(measured.machine, folders), Path(measured.file).expanduser())
    if text.lower().endswith(".json"):
        path = Path(text).expanduser()
        if not is_there(path):
            raise InputError(
                "UNKNOWN_MACHINE",
                "cell.machine",
                "machine file {} does not exist; check the path",
                text,
            )
        return _parse(read(path))
    urdf_reference = reference(text)
    if urdf_reference is not None:
        return machine_of_description(f"{urdf_reference}", *urdf_machine.describe(urdf_reference))
    path = file_of(text, folders)
    machine = (
        _built_in(path, locate(path).stat().st_mtime_ns)
        if path.parent == BUILT_IN
        else _parse(read(path))
    )
    if machine.id != text:
        raise InputError(
            "BAD_MACHINE",
            f"{path}: id",
            "{!r} differs from the file name, {!r}; rename the machine or the file",
            machine.id,
            text,
        )
    return machine


@functools.lru_cache(maxsize=8)
def _built_in(path: Path, _: int) -> Machine:
    """Return a built-in machine, cached because every stage of a job asks for it."""
    return _parse(read(path))


def file_of(name: str, folders: Sequence[Path | str] = ()) -> Path:
    """Return the file of a machine id. Raises InputError UNKNOWN_MACHINE if there is none."""
    for folder in (*folders, BUILT_IN):
        path = Path(folder).expanduser() / f"{name}.json"
        if path.stem == name and is_there(path):  # a name may be too long for the file system
            return path

    raise unknown(name, sorted(_files(folders)))


def parse(text: str, path: Path) -> Machine:
    """Return the machine of a machine file text.

    `path` names the file in errors and locates its shapes; it need not exist yet. Raises
    InputError BAD_MACHINE as `load` does.
    """
    return _parse(Node(json.loads(text), path))


def _files(folders: Sequence[Path | str]) -> dict[str, Path]:
    files = {path.stem: path for path in BUILT_IN.glob("*.json")}
    for folder in reversed(folders):
        files.update((path.stem, path) for path in Path(folder).expanduser().glob("*.json"))
    return files


def _parse(top: Node) -> Machine:
    top.only(*KEYS)
    keys = (
        "name",
        "label",
        "type",
        "origin",
        "rpy",
        "axis",
        "max_speed",
        "max_acceleration",
        "max_jerk",
    )
    joints = [joint.only(*keys) for joint in top["joints"].items()]
    if not joints:
        raise top["joints"].bad("the machine has no joint; add a joint for each axis")
    count = len(joints)
    sliding = np.array([file.slides(joint) for joint in joints])
    units = unit_values(sliding)
    # robot axes are numbered unless the file has the pendant's labels; machine tool axes have names
    names = tuple(
        file.name_of(joint, f"q{index + 1}", bool(sliding.any()))
        for index, joint in enumerate(joints)
    )
    controller = top["controller"].only(
        "matrix", "offset", "remark", "posts", "pulses_per_degree", "speed_unit"
    )
    chain = Chain(
        np.stack([joint.pose() for joint in joints]),
        np.stack([file.unit_of(joint["axis"]) for joint in joints]),
        top["flange"].only("origin", "rpy").pose(),
        sliding,
    )
    links = tuple(joint["name"].text() for joint in joints)
    shapes = link_shapes(top, links)
    arm, no_arm = (
        (file.opw_arm(top["opw"], count), "") if top.has("opw") else file.recognise_arm(chain)
    )
    machine = Machine(
        id=top["id"].text(),
        title=top["title"].text(),
        axes=names,
        chain=chain,
        arm=arm,
        no_arm=no_arm,
        base=top["base"].only("origin", "rpy").pose() if top.has("base") else np.eye(4),
        max_speed=np.array([file.maximum_of(joint, "max_speed", "a speed") for joint in joints])
        * units,
        limit_sets={
            name: file.limits_of(name, node, names, units) for name, node in top["limits"].pairs()
        },
        controller_matrix=controller["matrix"].matrix(count, count),
        controller_offset=controller["offset"].numbers(count) * units,
        controller_remark=controller["remark"].text(),
        posts=controller["posts"].texts() if controller.has("posts") else None,
        pulses_per_degree=file.pulses_of(controller, count),
        speed_unit=file.speed_unit_of(controller["speed_unit"])
        if controller.has("speed_unit")
        else "",
        sources=top["sources"].texts(),
        remarks=top["remarks"].texts() if top.has("remarks") else (),
        max_acceleration=np.array(
            [file.maximum_of(joint, "max_acceleration", "an acceleration") for joint in joints]
        )
        * units,
        max_jerk=np.array([file.maximum_of(joint, "max_jerk", "a jerk") for joint in joints])
        * units,
        shapes=shapes,
        payload=file.payload_of(top),
        warnings=file.warnings_of(top),
        bodies=link_bodies(top, links, shapes),
    )
    if MAKER not in machine.limit_sets:
        raise top["limits"].bad(Text("the set {!r} is missing; add the set", MAKER))
    if abs(np.linalg.det(machine.controller_matrix)) < 1e-9:
        raise controller["matrix"].bad(
            "the matrix has no inverse; copy the matrix of the controller"
        )
    for array in (
        machine.base,
        machine.max_speed,
        machine.max_acceleration,
        machine.max_jerk,
        machine.controller_matrix,
        machine.controller_offset,
    ):
        array.flags.writeable = False
    file.check(chain, machine.opw, top["check_poses"])
    return machine


def _calibrated(machine: Machine, path: Path) -> Machine:
    """Return the machine with the calibrated joint frames of one robot and their inverse."""
    if not isinstance(machine.arm, ParallelAxesArm):
        raise InputError(
            "BAD_CALIBRATION",
            "cell.machine",
            "only Universal Robots arms have a calibration, not {}; remove the calibration",
            machine.title,
        )
    poses, robot = calibration.read(path)
    chain = calibration.calibrated(machine.chain, machine.base, poses, path)
    text = f"{path.name} ({robot})" if robot else path.name
    return replace(
        machine,
        chain=chain,
        arm=CalibratedArm(machine.arm, chain),
        sources=(*machine.sources, text),
    )


def machine_of_description(source: str, description: Description, arm: SerialArm | None) -> Machine:
    """Return the machine of a URDF, with its limits and speeds.

    The controller is unknown, so no post writes for it.

    Parameters
    ----------
    source : str
        File name.
    description : Description
        The chain and its data.
    arm : SerialArm or None
        Inverse of the arm; None for a five-axis machine.

    Returns
    -------
    Machine
        The machine.
    """
    count = description.chain.axes
    none = np.zeros((0, count))
    names = (
        description.joints
        if description.chain.sliding.any()
        else tuple(f"q{index + 1}" for index in range(count))
    )
    limits = Limits(
        name=MAKER,
        lower=description.lower,
        upper=description.upper,
        coefficients=none,
        coupled_lower=none[:, 0],
        coupled_upper=none[:, 0],
        labels=names,
        source=source,
    )
    unknown = np.full(count, math.inf)
    return Machine(
        id=description.name,
        title=description.name,
        axes=names,
        chain=description.chain,
        arm=arm,
        no_arm="",
        base=np.eye(4) if description.base is None else description.base,
        max_speed=description.max_speed,
        limit_sets={MAKER: limits},
        controller_matrix=np.eye(count),
        controller_offset=np.zeros(count),
        controller_remark=UNKNOWN_REMARK,
        posts=(),
        pulses_per_degree=(),
        speed_unit="",
        sources=(source,),
        remarks=description.notes,
        max_acceleration=unknown,
        max_jerk=unknown,
        shapes=description.shapes,
        bodies=description.bodies,
        of_urdf=True,
    )


# ---- Data of known machines for choosing one, without reading their geometry


@dataclass(frozen=True)
class Entry:
    """Data of a machine file.

    reach: mm. payload: kg. Both are None if the file does not state them. posts: None for any.
    """

    id: str
    title: str
    reach: float | None
    payload: float | None
    posts: tuple[str, ...] | None

    def is_of(self, maker: str) -> bool:
        """Whether title or id begins with the words of a manufacturer.

        For a Yaskawa machine, 'Yaskawa' and 'motoman' both match. Accents and case are ignored.
        """
        maker_name = _plain(maker)
        return any(
            _plain(name).startswith(f"{maker_name} ")
            for name in (self.title, self.id.replace("-", " "))
        )


def entries(folders: Sequence[Path | str] = ()) -> list[Entry]:
    """Return all machines, built in and in the user's `folders`, sorted by id.

    Invalid machine files are skipped. Raises InputError BAD_MACHINE if reach or payload is not a
    number.
    """
    names = [name for name, title in known(folders) if not title.startswith(REFUSED)]
    return [_entry(name, read(file_of(name, folders))) for name in names]


def select_machines(
    entries: Sequence[Entry],
    maker: str | None = None,
    reach: float = 0.0,
    payload: float = 0.0,
    post: str | None = None,
) -> list[Entry]:
    """Return the machines that meet the requirements.

    A machine whose file does not state a required value is omitted.

    Parameters
    ----------
    entries : sequence of Entry
        The known machines.
    maker : str or None, optional
        Manufacturer; None for any.
    reach : float, optional
        Minimum reach, mm; 0 for any.
    payload : float, optional
        Minimum payload, kg; 0 for any.
    post : str or None, optional
        Post that the controller must support; None for any.

    Returns
    -------
    list of Entry
        The machines in the order of `entries`.

    Raises
    ------
    InputError
        USAGE for an unknown manufacturer.
    """
    if maker is not None and not any(entry.is_of(maker) for entry in entries):
        makers = ", ".join(sorted({entry.title.split()[0] for entry in entries}))
        raise InputError(
            "USAGE",
            "freecad-am machines",
            "no known machine is from {!r}; use one of {}",
            maker,
            makers,
        )
    return [
        entry
        for entry in entries
        if (maker is None or entry.is_of(maker))
        and (reach <= 0.0 or (entry.reach is not None and entry.reach >= reach))
        and (payload <= 0.0 or (entry.payload is not None and entry.payload >= payload))
        and (post is None or entry.posts is None or post in entry.posts)
    ]


def _entry(name: str, top: Node) -> Entry:
    controller = top["controller"] if top.has("controller") else top
    return Entry(
        name,
        top["title"].text(),
        _figure(top, "reach", "mm"),
        _figure(top, "payload", "kg"),
        controller["posts"].texts() if controller.has("posts") else None,
    )


def _figure(top: Node, key: str, unit: str) -> float | None:
    return top[key][unit].number() if top.has(key) and top[key].has(unit) else None


def _plain(text: str) -> str:
    letters = unicodedata.normalize("NFKD", text)
    return (
        "".join(letter for letter in letters if not unicodedata.combining(letter))
        .casefold()
        .strip()
    )
