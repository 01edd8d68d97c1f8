# SPDX-License-Identifier: LGPL-2.1-or-later
"""The hand of a person at the window."""

import subprocess
import time


class Hand:
    """The mouse and the keys themselves: events go through the X server, to whatever is under the pointer."""

    def __init__(self, person):
        self.person = person

    def do(self, *words):
        process = subprocess.Popen(["xdotool", *map(str, words)])
        self.person.until(lambda: process.poll() is not None, "xdotool", 10)
        assert process.returncode == 0
        self.person.idle(0.1)

    def at(self, place, *held):
        """Click at a place of the screen while keys are held."""
        keys = [word for key in held for word in ("keydown", key)]
        self.do("mousemove", *place)  # so that the view sees the pointer come
        released = [word for key in held for word in ("keyup", key)]
        self.do(*keys, "click", "1", *released)

    def click(self, widget):
        """Click in the middle of a widget, once it no longer moves; one of a panel is scrolled to."""
        self.reveal(widget)

        def middle():
            centre = widget.mapToGlobal(widget.rect().center())
            return centre.x(), centre.y()

        seen = [middle()]
        while len(seen) < 4 or len(set(seen[-4:])) > 1:
            self.person.idle(0.04)
            seen.append(middle())
        self.at(seen[-1])

    def reveal(self, widget):
        """Turn the wheel over the margin of a panel until all of a widget is in sight, or as much of it as goes in."""
        areas = [
            one
            for one in self.person.present(self.person.widgets.QScrollArea)
            if one.isVisible() and one.isAncestorOf(widget)
        ]
        if not areas:
            return
        area = next(
            one
            for one in areas
            if not any(one is not other and one.isAncestorOf(other) for other in areas)
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
        """Type over what a field holds, and leave it."""
        field = self.person.field(panel, name)
        parts = [field, *field.findChildren(self.person.widgets.QWidget)]
        # on a busy machine the click may be at work when the first key comes, and what a preview tells in the panel may
        # move the field away from under the pointer: a person then clicks again
        for _ in range(3):
            self.click(field)
            end = time.monotonic() + 3.0
            while time.monotonic() < end and not any(part.hasFocus() for part in parts):
                self.person.idle(0.05)
            if any(part.hasFocus() for part in parts):
                break
        assert any(part.hasFocus() for part in parts), f"{name} does not get the keys"
        self.do("key", "ctrl+a")
        # letters that the keyboard has not are on it for as long as the rest is typed, and a busy window looks late
        self.do("type", "--delay", "20" if text.isascii() else "250", text)
        self.do("key", "Tab")

    def undo(self):
        self._when_able("Std_Undo")
        self.do("key", "ctrl+z")

    def redo(self):
        self._when_able("Std_Redo")
        self.do("key", "ctrl+shift+z")

    def _when_able(self, command):
        """Wait until a tool is lit: FreeCAD looks at them when it has nothing else to do, and takes no keys for others."""
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
        """The place of an object of the tree on the screen, brought into sight."""

        def there():
            trees = self.person.present(self.person.widgets.QTreeWidget)
            return [
                tree
                for tree in trees
                if tree.isVisible() and tree.findItems(label, _anywhere(self.person.core))
            ]

        tree = self.person.until(there, f"{label} in the tree", 5)[
            0
        ]  # which follows the document a little later
        item = tree.findItems(label, _anywhere(self.person.core))[0]
        tree.scrollToItem(item)
        self.person.idle(0.1)
        place = tree.visualItemRect(item).center()
        place.setX(
            tree.visualItemRect(item).left() + 48
        )  # on its text: before it FreeCAD 1.0 has an eye, which hides
        where = tree.viewport().mapToGlobal(place)
        return where.x(), where.y()

    def click_tree(self, label, *held):
        """Click an object in the tree."""
        self.at(self.in_tree(label), *held)

    def drag_in_tree(self, label, onto):
        """Drag an object of the tree onto another one, and drop it there."""
        self.in_tree(onto)  # both are brought into sight before either place is taken
        (x, y), (far_x, far_y) = self.in_tree(label), self.in_tree(onto)
        way = [(x + (far_x - x) * k // 4, y + (far_y - y) * k // 4) for k in (1, 2, 3, 4)]
        moves = [
            word
            for place in [*way, (far_x + 1, far_y)]
            for word in ("mousemove", *place, "sleep", 0.1)
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

    def click_face(self, obj, face, *held):
        """Click a face of an object where it is to be seen in the 3D view; what a panel covers is brought out from under it
        by the wheel (FreeCAD 1.1 lays panels over the view)."""
        view = self.person.gui.getDocument(obj.Document.Name).activeView()
        for _ in range(6):
            place = self.seen(view, obj, face)
            if place:
                self.at(place, *held)
                return
            corner = self.corner(view)
            self.do("mousemove", corner.x() + 5, corner.y() + view.getSize()[1] // 2, "click", 5)
            self.person.idle(0.2)
        raise AssertionError(f"{obj.Label} {face} is not to be seen")

    def seen(self, view, obj, face):
        """A place of the screen where a face of an object is seen, with a little of it all around; None without one."""
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
        """The upper left corner of a 3D view on the screen."""
        return view.graphicsView().mapToGlobal(self.person.core.QPoint(0, 0))


def _anywhere(qt_core):
    return qt_core.Qt.MatchExactly | qt_core.Qt.MatchRecursive
