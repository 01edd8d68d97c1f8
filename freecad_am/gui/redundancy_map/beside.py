# SPDX-License-Identifier: LGPL-2.1-or-later
"""The widgets next to the map: display options, curve coefficients and statistics."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from PySide import QtCore, QtGui

from ...core.kinematics.cell import Cell as Station
from ...core.kinematics.inverse import spherical_wrist
from ...core.kinematics.machines.machine import Machine
from ...core.parameters.joints import HIGHEST
from ...core.planning import redundancy_curve as rotation_curve
from ...core.planning.redundancy_curve import Followed, Sums
from ...core.planning.redundancy_map import ROTATION, RZ
from ...core.types import Array
from ..colours import INVALID, PLAIN, of, set_role
from ..in_language import link_touches, tr
from ..widgets.steady import Scrolled
from ..worker import Background, Worker
from .board import COLOURS, OWN_CURVE, PLANNED_CURVE, Board, Cell
from .draft import CONSTANT, POLYNOMIALS, Draft
from .painting import KINDS

# ---- Fields: display of the map, and coefficients of the curve

STEP = 1.0  # deg; spin-box step of a coefficient
MAX_VALUE = 1e6
AXES, CURVES = (RZ, ROTATION), (POLYNOMIALS, CONSTANT)


class Controls(QtGui.QWidget):
    """Call functions with the user's choices; `fill` shows a state without calling any."""

    def __init__(
        self,
        on_choice: Callable[[], None],
        curve: Callable[[], None],
        set_value: Callable[[int, float], None],
    ) -> None:
        super().__init__()
        self.setObjectName("controls")
        self.filling = False
        self.chosen, self.curve, self.set_value = on_choice, curve, set_value
        self.grid = QtGui.QGridLayout(self)
        self.grid.setContentsMargins(4, 2, 4, 2)
        self.grid.setVerticalSpacing(3)
        self.layer = self._box(
            "layer", tr("Layer"), tr("The layer shown; -1 for all layers"), on_choice
        )
        self.layer.setSpecialValueText(tr("all"))
        self.branch = self._combo(
            "branch",
            tr("Branch"),
            tr("Shoulder, elbow and wrist, with the share of the map within reach and limits"),
            on_choice,
        )
        self.kind = self._combo(
            "colours", tr("Colours"), tr("Quantity shown by the colours"), on_choice
        )
        self.kind.addItems([tr(kind) for kind in KINDS])
        help = tr(
            "RZ as in Chalvin 2020, the true tool rotation, or an external axis that is not on "
            "the other axis of the map"
        )
        self.axis = self._combo("axis", tr("Vertical axis"), help, on_choice)
        self.across = self._add_across()
        self.type = self._combo(
            "curve", tr("Curve"), tr("One polynomial per bead, or one RZ for the whole job"), curve
        )
        self.type.addItems([tr("polynomials"), tr("constant RZ")])
        self.bead = self._box(
            "bead",
            tr("Bead"),
            tr("The bead whose polynomial is shown; click the map to choose a bead"),
            curve,
        )
        self.degree = self._box("degree", tr("Degree"), tr("Degree of the polynomials"), curve)
        self.degree.setRange(0, HIGHEST)
        self.together = QtGui.QCheckBox(tr("All beads together"))
        self.together.setObjectName("together")
        self.together.setToolTip(tr("Change all beads together"))
        self.together.setChecked(True)
        self.grid.addWidget(self.together, self.grid.rowCount(), 0, 1, 2)
        self.coefficients, self.names = [], []
        for number in range(HIGHEST + 1):
            box = QtGui.QDoubleSpinBox()
            box.setObjectName(f"c{number}")
            box.setRange(-MAX_VALUE, MAX_VALUE)
            box.setDecimals(3)
            box.setSingleStep(STEP)
            box.setKeyboardTracking(False)
            box.setSuffix(
                " °"
                if number == 0
                else " °/" + tr("turn") + ("" if number == 1 else "²³⁴⁵⁶"[number - 2])
            )
            box.valueChanged.connect(lambda value, number=number: self._entered(number, value))
            row = self.grid.rowCount()
            self.names.append(QtGui.QLabel())
            self.grid.addWidget(self.names[-1], row, 0)
            self.grid.addWidget(box, row, 1)
            self.coefficients.append(box)
        self.grid.setColumnStretch(1, 1)
        self.grid.setRowStretch(self.grid.rowCount(), 1)

    def _box(self, name: str, text: str, help: str, act: Callable[[], None]) -> Any:
        box = QtGui.QSpinBox()
        box.valueChanged.connect(lambda *_: None if self.filling else act())
        return self._add(box, name, text, help)

    def _combo(self, name: str, text: str, help: str, act: Callable[[], None]) -> Any:
        combo = QtGui.QComboBox()
        combo.setMinimumContentsLength(8)
        combo.activated.connect(lambda *_: None if self.filling else act())
        return self._add(combo, name, text, help)

    def _add_across(self) -> Any:
        help = tr(
            "The path, or an external axis at the point clicked last, with the other axes as "
            "planned there"
        )
        return self._combo("across", tr("Horizontal axis"), help, self.chosen)

    def _add(self, widget: Any, name: str, text: str, help: str) -> Any:
        widget.setObjectName(name)
        widget.setToolTip(help)
        row = self.grid.rowCount()
        self.grid.addWidget(QtGui.QLabel(text), row, 0)
        self.grid.addWidget(widget, row, 1)
        return widget

    def _entered(self, number: int, value: float) -> None:
        if not self.filling:
            self.set_value(number, value)

    def selection(self) -> tuple[int | None, str, int | None, int | None]:
        """Return layer (None for all), vertical rotation, horizontal external axis (None for the
        path), and vertical external axis (None for the rotation).
        """
        layer, across, axis = (
            self.layer.value(),
            self.across.currentIndex() - 1,
            self.axis.currentIndex(),
        )
        up = (
            axis - len(AXES) if axis >= len(AXES) and across not in (-1, axis - len(AXES)) else None
        )
        return (
            None if layer < 0 else layer,
            AXES[axis if axis < len(AXES) else 0],
            across if across >= 0 else None,
            up,
        )

    # ---- display

    def fill(self, board: Board, draft: Draft, bead: int) -> None:
        """Show a state."""
        self.filling = True
        source = board.source
        self.layer.setRange(-1, max(layer for layer, _ in source.places))
        self.layer.setValue(-1 if board.layer is None else board.layer)
        self._fill_branches(board, draft.branch)
        self._fill_across(board)
        self.type.setCurrentIndex(CURVES.index(draft.kind))
        constant = draft.kind == CONSTANT
        self.bead.setRange(board.beads[0], board.beads[-1])
        self.bead.setValue(bead)
        self.bead.setSuffix("  ({}/{})".format(*source.places[bead]))
        self.degree.setValue(draft.degree)
        for widget in (self.bead, self.degree, self.together):
            widget.setEnabled(not constant)
        values = (
            [draft.rz]
            if constant
            else [c * (2.0 * np.pi) ** k for k, c in enumerate(draft.coefficients[bead])]
        )
        for number, (name, box) in enumerate(zip(self.names, self.coefficients, strict=True)):
            is_used = number < len(values)
            name.setVisible(is_used)
            box.setVisible(is_used)
            name.setText("RZ" if constant else _coefficient(number))
            if is_used and not (
                box.hasFocus() and abs(box.value() - np.degrees(values[number])) < 6e-4
            ):
                box.setValue(float(np.degrees(values[number])))
        self.filling = False

    def _fill_across(self, board: Board) -> None:
        machine = board.source.cell.machine
        external = list(machine.axes[len(machine.axes) - machine.external :])
        names = [tr("the path"), *external]
        for combo, texts in (
            (self.across, names),
            (self.axis, [tr("RZ"), tr("rotation"), *external]),
        ):
            if [combo.itemText(k) for k in range(combo.count())] != texts:
                combo.clear()
                combo.addItems(texts)
        self.axis.setCurrentIndex(
            AXES.index(board.axis) if board.up is None else len(AXES) + board.up
        )
        self.across.setCurrentIndex(0 if board.across is None else board.across + 1)
        self.across.setEnabled(len(names) > 1)

    def _fill_branches(self, board: Board, branch: int) -> None:
        served = None if board.map is None else board.reachable_shares()
        texts = []
        for number in range(8):
            text = " ".join(spherical_wrist.branch_name(number))
            text += "" if served is None else f"   {100.0 * served[number]:.0f} %"
            texts.append(text + ("   " + tr("(planned)") if number == board.source.branch else ""))
        if [self.branch.itemText(k) for k in range(self.branch.count())] != texts:
            self.branch.clear()
            self.branch.addItems(texts)
        self.branch.setCurrentIndex(branch)


def _coefficient(number: int) -> str:
    """Return the label of a coefficient of a polynomial over the turns of a bead."""
    words = {0: tr("RZ at the start"), 1: tr("Linear"), 2: tr("Quadratic"), 3: tr("Cubic")}
    return words.get(number) or tr("Degree {}").format(number)


# ---- Statistics of the edited curve: at once for a sample of its points, shortly after for all points

COLUMNS = 6


class Figures(QtGui.QTableWidget):
    """Table with one row per curve name; `changed` is called when a box was clicked."""

    def __init__(self, changed: Callable[[], None]) -> None:
        super().__init__(0, COLUMNS)
        self.setObjectName("figures")
        self.rows: dict[str, int] = {}
        self.changed = changed
        self.filling = False
        self.setHorizontalHeaderLabels(
            [tr("Curve"), tr("Lost"), tr("Margin"), tr("Condition"), tr("Speed"), tr("Criterion")]
        )
        helps = (
            tr("Shown on the map"),
            tr("Points that are unreachable, beyond a limit, near a singularity or not allowed"),
            tr("The smallest distance to a limit, as a share of half the range of the joint"),
            tr("The smallest inverse condition number of the Jacobian, sigma_min / sigma_max"),
            tr("The largest joint speed at the travel speed, as a share of its maximum"),
            tr("The displacement of the joints (Chalvin 2020, eq. 17), and its ratio to the plan"),
        )
        for number, help in enumerate(helps):
            self.horizontalHeaderItem(number).setToolTip(help)
        self.verticalHeader().hide()
        self.verticalHeader().setDefaultSectionSize(int(1.6 * self.fontMetrics().height()))
        self.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)
        self.setSelectionMode(QtGui.QAbstractItemView.NoSelection)
        self.horizontalHeader().setStretchLastSection(True)
        self.setMinimumWidth(200)
        self.itemChanged.connect(self._clicked)

    def set(
        self,
        name: str,
        title: str,
        colour: tuple[int, int, int],
        sums: Sums,
        planned: Sums | None,
        about: bool = False,
        help: str = "",
    ) -> None:
        """Fill a row; a new name adds a row. about: the statistics cover only some of the points."""
        self.filling = True
        new = name not in self.rows
        if new:
            self.rows[name] = self.rowCount()
            self.insertRow(self.rowCount())
        row, sign = self.rows[name], "≈ " if about else ""
        reached = np.isfinite(sums.margin)
        times = (
            ""
            if planned is None or not planned.displacement
            else f" (×{sums.displacement / planned.displacement:.3g})"
        )
        texts = (
            title,
            f"{sums.lost}",
            f"{100.0 * sums.margin:.1f} %" if reached else tr("unreachable"),
            f"{sums.condition:.4f}",
            f"{100.0 * sums.ratio:.1f} %" if np.isfinite(sums.ratio) else "—",
            f"{sums.displacement:.3g}{times}" if np.isfinite(sums.displacement) else "—",
        )
        for column, text in enumerate(texts):
            item = self.item(row, column)
            if item is None:
                item = QtGui.QTableWidgetItem()
                self.setItem(row, column, item)
            item.setText(text if column in (0, 1) else f"{sign}{text}")
        mark = self.item(row, 0)
        if new:
            mark.setFlags(QtCore.Qt.ItemIsEnabled | QtCore.Qt.ItemIsUserCheckable)
            mark.setCheckState(QtCore.Qt.Checked)
            image = QtGui.QPixmap(12, 12)
            image.fill(QtGui.QColor(*colour))
            mark.setIcon(QtGui.QIcon(image))
        mark.setToolTip(help)
        wound = tr(
            "{} exceed a limit only because an axis runs out of turns along its bead"
        ).format(sums.wound)
        self.item(row, 1).setToolTip(wound if sums.wound else "")
        for column, wrong in ((1, sums.lost > 0), (4, sums.ratio > 1.0)):
            ink = of(INVALID if wrong else PLAIN)
            self.item(row, column).setForeground(QtGui.QBrush(ink))
        self.resizeColumnsToContents()
        self.filling = False

    def shows(self, name: str) -> bool:
        """Whether a curve is visible."""
        return name in self.rows and self.item(self.rows[name], 0).checkState() == QtCore.Qt.Checked

    def hide_curve(self, name: str) -> None:
        """Hide a curve on the map, as its box does."""
        self.item(self.rows[name], 0).setCheckState(QtCore.Qt.Unchecked)

    def clear_all(self) -> None:
        """Remove all rows."""
        self.filling = True
        self.setRowCount(0)
        self.rows.clear()
        self.filling = False

    def _clicked(self, item: Any) -> None:
        if not self.filling and item.column() == 0:
            self.changed()


MIN_WIDTH = 190  # pixels; minimum width of the controls


class Form(QtGui.QWidget):
    """The widgets of the map; the caller connects their signals."""

    def __init__(self, canvas: Any, controls: Any, figures: Any) -> None:
        super().__init__()
        self.figures = figures
        row, left = QtGui.QHBoxLayout(self), QtGui.QVBoxLayout()
        beside = QtGui.QWidget()
        right = QtGui.QVBoxLayout(beside)
        right.setContentsMargins(0, 0, 0, 0)
        row.setContentsMargins(4, 2, 4, 4)
        row.setSpacing(4)
        self.readout = QtGui.QLabel()
        self.readout.setObjectName("readout")
        self.readout.setMinimumHeight(2 * self.readout.fontMetrics().height() + 4)
        self.readout.setSizePolicy(QtGui.QSizePolicy.Ignored, QtGui.QSizePolicy.Preferred)
        left.addWidget(canvas, 1)
        left.addWidget(self.readout)
        self.verdict = QtGui.QLabel()
        self.verdict.setObjectName("verdict")
        self.verdict.setWordWrap(True)
        self.joints = QtGui.QLabel()
        self.joints.setObjectName("joints")
        self.joints.setWordWrap(True)
        self.joints.setTextFormat(QtCore.Qt.RichText)
        self.joints.setToolTip(tr("Range of each joint on this curve; red beyond a limit"))
        right.addWidget(figures, 1)
        right.addWidget(self.joints)
        right.addWidget(self.verdict)
        grid = QtGui.QGridLayout()
        self.buttons = {
            name: _button(name, text, help)
            for name, text, help in (
                (
                    "use",
                    tr("Use this"),
                    tr("Use the curve for the joint path, and plan it again"),
                ),
                (
                    "free",
                    tr("Let the planner choose"),
                    tr("Plan the joint path again layer by layer, without a given curve"),
                ),
                ("again", tr("Back"), tr("Reset to the planned curve")),
                (
                    "compare",
                    tr("Compare methods"),
                    tr(
                        "Plan constant, point-by-point and layer-by-layer in this configuration, "
                        "for comparison"
                    ),
                ),
                ("save", tr("Save…"), tr("Save as an image (PNG, SVG, PDF), or the values (CSV)")),
            )
        }
        for number, button in enumerate(self.buttons.values()):
            grid.addWidget(button, number // 2, number % 2)
        right.addLayout(grid)
        row.addLayout(left, 7)
        row.addWidget(Scrolled(controls, MIN_WIDTH), 2)
        row.addWidget(Scrolled(beside), 4)

    def tell(self, text: str, wrong: bool = False) -> None:
        """Show the state of the curve, or the progress."""
        self.verdict.setText(text)
        set_role(self.verdict, INVALID if wrong else PLAIN)

    def show_joints(self, ranges: list[tuple[str, bool]]) -> None:
        """Show the range of each joint, and whether it exceeds a limit."""
        texts = [(text.replace(" ", "&nbsp;"), wrong) for text, wrong in ranges]
        coloured = [
            f'<font color="{of(INVALID).name()}">{text}</font>' if wrong else text
            for text, wrong in texts
        ]
        self.joints.setText(" &nbsp; ".join(coloured))


def _button(name: str, text: str, help: str) -> Any:
    button = QtGui.QPushButton(text)
    button.setObjectName(name)
    button.setToolTip(help)
    return button


PAST = 1e-9  # rad; tolerance for rounding


def readout(cell: Cell, machine: Machine) -> str:
    """Return two lines: position, rotation and margins; and the joints."""
    layer, bead, point = cell.place
    where = tr("Layer {} bead {} point {}").format(layer, bead, point)
    turned = f"RZ {np.degrees(cell.rz):.1f}°   " + tr("rotation") + f" {np.degrees(cell.phi):.1f}°"
    notes = []
    if not np.isfinite(cell.joints).all():
        return f"{where}   {turned}\n" + tr("out of reach in this configuration")
    if cell.margin < 0.0:
        notes.append(tr("beyond a limit"))
    if cell.condition < cell.threshold:
        notes.append(tr("near a singularity"))
    if cell.outside:
        notes.append(tr("rotation not allowed"))
    if cell.touching:
        notes.append(tr("the nozzle touches platform or part"))
    if cell.arm is not None:
        notes.append(link_touches(*cell.arm))
    margin = tr("margin {:.1f} % ({})").format(100.0 * cell.margin, cell.nearest)
    condition = tr("condition {:.4f}, least {:.4f}").format(cell.condition, cell.threshold)
    joints = "   ".join(
        f"{name} {value:.2f}{unit}"
        for name, value, unit in zip(
            machine.axes, cell.joints / machine.unit_values, _units(machine), strict=True
        )
    )
    return f"{where}   {turned}   {margin}   {condition}   {', '.join(notes)}\n{joints}"


def certified(optimality: Mapping[str, Any] | None) -> str:
    """Describe the certificate of a plan; '' without one."""
    if optimality is None:
        return ""
    text = tr(
        "Certificate: {:.4g} as planned, lower bound over all rotations {:.4g}: a gap of {:.1f} "
        "%, the largest, {:.1f} %, in layer {} bead {}"
    )
    worst = optimality["worst"]
    return text.format(
        optimality["objective"],
        optimality["bound"],
        100.0 * optimality["gap"],
        100.0 * worst["gap"],
        worst["layer"],
        worst["bead"],
    )


def joint_ranges(joints: Array, station: Station) -> list[tuple[str, bool]]:
    """Return the range of each axis of joints (T, axes), deg, and whether it exceeds the axis
    limits.
    """
    reached = joints[np.isfinite(joints).all(axis=1)]
    if not len(reached):
        return []
    low, high = reached.min(axis=0), reached.max(axis=0)
    units = station.machine.unit_values
    past = (low < station.limits.lower - PAST) | (high > station.limits.upper + PAST)
    return [
        (f"{name} {a:.1f}…{b:.1f}{unit}", bool(wrong))
        for name, a, b, wrong, unit in zip(
            station.machine.axes,
            low / units,
            high / units,
            past,
            _units(station.machine),
            strict=True,
        )
    ]


def _units(machine: Machine) -> list[str]:
    """Return the units of the axes."""
    return [" mm" if unit == "mm" else "°" for unit in machine.units]


class Consequences:
    """Update status and statistics after changes of the curve.

    `status` returns the state of the joint path, and whether it is an error. followed: the curve
    evaluated at the sample points of a drag.
    """

    followed: Followed

    def __init__(self, owner: Any, form: Form, status: Callable[[], tuple[str, bool]]) -> None:
        self.form, self.status = form, status
        self.background = Background(owner)

    def take(self, draft: Draft) -> None:
        """Switch to another draft, which equals its plan."""
        self.draft = draft
        self.planned = rotation_curve.sums(draft.follow(draft.live.planned))
        self.planned_exact: Sums | None = None

    def planned_sums(self) -> Sums:
        """Return the statistics of the plan, of all points if computed."""
        return self.planned_exact or self.planned

    def cancel(self) -> None:
        """Cancel the running computation."""
        self.background.cancel()

    def now(self) -> None:
        """Show the statistics of the edited curve at once."""
        draft = self.draft
        self.followed = draft.evaluate()
        self._show_sums(rotation_curve.sums(self.followed), self.planned, draft.thinned)
        self.form.show_joints(joint_ranges(self.followed.joints, draft.source.cell))

    def exactly(self) -> None:
        """Compute the statistics at all points if the draft is sampled."""
        draft, planned = self.draft, self.planned_exact
        if not draft.thinned:
            return
        duplicate = draft.copied()

        def work() -> tuple[Sums, Sums]:
            full = duplicate.full
            sums = rotation_curve.sums(
                duplicate.follow(duplicate.phi(full.points, full.points.bead), False)
            )
            if planned is not None:
                return sums, planned
            of_plan = duplicate.copied()
            of_plan.branch = duplicate.source.branch
            return sums, rotation_curve.sums(of_plan.follow(full.planned, False))

        def show(worker: Worker) -> None:
            sums_pair = worker.result()
            if draft is self.draft:
                draft.learn(duplicate)
                self.planned_exact = sums_pair[1]
                self._show_sums(*sums_pair, False)

        self.background.start(work, show)

    def _show_sums(self, sums: Sums, planned: Sums, about: bool) -> None:
        self.form.figures.set(OWN_CURVE, tr("This curve"), COLOURS[OWN_CURVE], sums, planned, about)
        self.form.figures.set(
            PLANNED_CURVE, tr("As planned"), COLOURS[PLANNED_CURVE], planned, None, about
        )
        edited = self.draft.edited
        self.form.buttons["use"].setEnabled(edited)
        if sums.lost:
            text, wrong = (
                tr("{} of the tested points fail and are red").format(sums.lost),
                True,
            )
        elif edited and sums.ratio > 1.0:
            warning = tr(
                "A joint would need {:.0f} % of its maximum speed: the planner will slow the "
                "bead down, or reject the curve"
            )
            text, wrong = warning.format(100.0 * sums.ratio), True
        else:
            text, wrong = self.status() if not edited else (tr("All points are feasible"), False)
        certificate = certified(self.draft.source.planned.optimality)
        self.form.tell("\n".join(filter(None, (text, certificate if not edited else ""))), wrong)
