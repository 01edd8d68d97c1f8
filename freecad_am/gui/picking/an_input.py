# SPDX-License-Identifier: LGPL-2.1-or-later
"""An input of a stage in its panel."""

from __future__ import annotations

from typing import Any

from ...objects.stage_parts import Link


class Input:
    """A row of the panel that gives arguments of the macro function."""

    label = ""
    link: Link
    widget: Any = None
    places: tuple[str, ...] = ()  # what errors call it, other than by its link

    def tell(self, text: str) -> None:
        """Something about it; the panel shows it under the widget."""

    @property
    def missing(self) -> str:
        """What to do when there is nothing to choose, '' when there is."""
        return ""

    def arguments(self) -> dict[str, str]:
        """Arguments by keyword as Python texts."""
        raise NotImplementedError

    def applied(self) -> None:
        """What is entered is what the document has now."""

    def stored(self, obj: Any) -> Any:
        """What a stage in the document has of it."""
        return getattr(obj, self.link.name)

    def show_stored(self, stored: Any) -> None:
        """Show what a stage in the document has, in place of what is there."""
        raise NotImplementedError
