# SPDX-License-Identifier: LGPL-2.1-or-later
"""Move the mouse and press keys like a person at the window."""

import subprocess
import time


class Hand:
    """Send mouse and key events through the X server, to the widget under the pointer."""

    def __init__(self, person):
        self.person = person

    def do(self, *words):
        process = subprocess.Popen(["xdotool", *map(str, words)])
        self.person.until(lambda: process.poll() is not None, "xdotool", 10)
        assert process.returncode == 0
        self.person.idle(0.1)

    def at(self, position, *held_keys):
        """Click at a position on the screen while keys are down."""
        keys = [word for key in held_keys for word in ("keydown", key)]
        self.do("mousemove", *position)  # so that the view sees the pointer arrive
        released = [word for key in held_keys for word in ("keyup", key)]
        self.do(*keys, "click", "1", *released)

    def click(self, widget):
        """Click in the middle of a widget after it stops moving; scroll to it if it is in a
        panel."""
        self.reveal(widget)

        def middle():
            centre = widget.mapToGlobal(widget.rect().center())
            return centre.x(), centre.y()

        positions = [middle()]
        while len(positions) < 4 or len(set(positions[-4:])) > 1:
            self.person.idle(0.04)
            positions.append(middle())
        self.at(positions[-1])

    def reveal(self, widget):
        """Turn the wheel over the margin of a panel until the whole widget is visible, or as much
        of it as fits."""
        areas = [
            area
            for area in self.person.present(self.person.widgets.QScrollArea)
            if area.isVisible() and area.isAncestorOf(widget)
        ]
        if not areas:
            return
        area = next(
            area
            for area in areas
            if not any(area is not outer and area.isAncestorOf(outer) for outer in areas)
        )
        sight = area.viewport()
        for _ in range(40):
            if widget.visibleRegion().boundingRect().height() >= min(
                widget.height(), sight.height()
            ):
                return
            margin = sight.mapToGlobal(self.person.core.QPoint(3, sight.height() // 2))
            below = widget.mapTo(sight, widget.rect().center()).y() > sight.height() // 2
            self.do("mousemove", margin.x(), margin.y(), "click", 5 if below else 4)
        raise AssertionError(f"{widget.objectName()} does not come in sight")

    def enter(self, panel, name, text):
        """Replace the text of a field, and leave it."""
        field = self.person.field(panel, name)
        widgets = [field, *field.findChildren(self.person.widgets.QWidget)]
        # on a busy machine the window may still process the click when the first key arrives, and a
        # preview's message may move the field away from the pointer: a person then clicks again
        for _ in range(3):
            self.click(field)
            end = time.monotonic() + 3.0
            while time.monotonic() < end and not any(widget.hasFocus() for widget in widgets):
                self.person.idle(0.05)
            if any(widget.hasFocus() for widget in widgets):
                break
        assert any(widget.hasFocus() for widget in widgets), f"{name} does not get the keys"
        self.do("key", "ctrl+a")
        # the keyboard gets missing letters while the text is typed, and a busy window reads them
        # late
        self.do("type", "--delay", "20" if text.isascii() else "250", text)
        self.do("key", "Tab")

    def undo(self):
        self._when_able("Std_Undo")
        self.do("key", "ctrl+z")

    def redo(self):
        self._when_able("Std_Redo")
        self.do("key", "ctrl+shift+z")

    def _when_able(self, command):
        """Wait until a tool is enabled: FreeCAD updates tools when it is idle, and ignores the keys
        of disabled ones."""
        bars = self.person.present(self.person.widgets.QToolBar)
        tools = [
            tool
            for bar in bars
            for tool in bar.actions()
            if command in (tool.objectName(), tool.data())
        ]
        assert tools, f"no toolbar has {command}"
        self.person.until(tools[0].isEnabled, f"{command} to be enabled", 5)

    def in_tree(self, label):
        """Scroll to an object in the tree and return its position on the screen."""

        def there():
            trees = self.person.present(self.person.widgets.QTreeWidget)
            return [
                tree
                for tree in trees
                if tree.isVisible() and tree.findItems(label, _anywhere(self.person.core))
            ]

        tree = self.person.until(there, f"{label} in the tree", 5)[
            0
        ]  # the tree follows the document a little later
        item = tree.findItems(label, _anywhere(self.person.core))[0]
        tree.scrollToItem(item)
        self.person.idle(0.1)
        position = tree.visualItemRect(item).center()
        position.setX(
            tree.visualItemRect(item).left() + 48
        )  # on its text: FreeCAD 1.0 has an eye before it, which hides the object
        where = tree.viewport().mapToGlobal(position)
        return where.x(), where.y()

    def click_tree(self, label, *keys):
        """Click an object in the tree."""
        self.at(self.in_tree(label), *keys)

    def drag_in_tree(self, label, onto):
        """Drag an object of the tree onto another one, and drop it there."""
        self.in_tree(onto)  # scroll to both before reading either position
        (x, y), (far_x, far_y) = self.in_tree(label), self.in_tree(onto)
        steps = [(x + (far_x - x) * k // 4, y + (far_y - y) * k // 4) for k in (1, 2, 3, 4)]
        moves = [
            word
            for position in [*steps, (far_x + 1, far_y)]
            for word in ("mousemove", *position, "sleep", 0.1)
        ]
        self.do(
            "mousemove",
            x,
            y,
            "sleep",
            0.1,
            "mousedown",
            1,
            "sleep",
            0.2,
            *moves,
            "sleep",
            0.3,
            "mouseup",
            1,
        )
        self.person.idle(0.5)

    def click_face(self, obj, face, *keys):
        """Click a face of an object where it is visible in the 3D view; if a panel covers it, turn
        the wheel until it is not (FreeCAD 1.1 puts panels over the view)."""
        view = self.person.gui.getDocument(obj.Document.Name).activeView()
        for _ in range(6):
            position = self.seen(view, obj, face)
            if position:
                self.at(position, *keys)
                return
            corner = self.corner(view)
            self.do("mousemove", corner.x() + 5, corner.y() + view.getSize()[1] // 2, "click", 5)
            self.person.idle(0.2)
        raise AssertionError(f"{obj.Label} {face} is not to be seen")

    def seen(self, view, obj, face):
        """Return a position on the screen where a face of an object and some margin around it are
        visible; None without one."""
        points, triangles = obj.Shape.getElement(face).tessellate(2.0)
        on_screen = getattr(view, "getPointOnViewport", None) or view.getPointOnScreen
        for corners in triangles:
            middle = (points[corners[0]] + points[corners[1]] + points[corners[2]]) / 3.0
            x, y = on_screen(middle)
            around = [
                view.getObjectInfo((x + dx, y + dy))
                for dx, dy in ((0, 0), (6, 0), (-6, 0), (0, 6), (0, -6))
            ]
            if all(
                info and (info["Object"], info["Component"]) == (obj.Name, face) for info in around
            ):
                where = self.corner(view) + self.person.core.QPoint(x, view.getSize()[1] - 1 - y)
                on_top = self.person.widgets.QApplication.widgetAt(where)
                if on_top is not None and view.graphicsView().isAncestorOf(on_top):
                    return where.x(), where.y()
        return None

    def corner(self, view):
        """Return the upper left corner of a 3D view on the screen."""
        return view.graphicsView().mapToGlobal(self.person.core.QPoint(0, 0))


def _anywhere(qt_core):
    return qt_core.Qt.MatchExactly | qt_core.Qt.MatchRecursive
