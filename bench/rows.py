# SPDX-License-Identifier: LGPL-2.1-or-later
"""A line of the benchmark: our cost, the cost of a named peer in the same run, and the required
ratio."""

from __future__ import annotations

from typing import NamedTuple


class Row(NamedTuple):
    """`ours` and `peer` in `unit`, medians of rounds in turns; `peer` is None where it is not
    installed. The peer must cost at least `required` times as much as ours."""

    name: str
    ours: float
    peer: float | None
    unit: str
    required: float

    @property
    def ratio(self) -> float | None:
        """Return the cost of the peer divided by ours."""
        return None if self.peer is None else self.peer / self.ours

    @property
    def short(self) -> bool:
        """Return True when the required ratio is missed."""
        return self.ratio is not None and self.ratio < self.required

    def line(self, judged: bool = True) -> str:
        """Return the comparison in words; `ran` instead of a verdict when it is not judged."""
        if self.peer is None or self.ratio is None:
            return f"  --   {self.name}: {self.ours:.3f} {self.unit}, peer not installed"
        mark = ("SHORT" if self.short else "ok") if judged else "ran"
        return (
            f"{mark:>5}  {self.name}: {self.ours:.3f} against {self.peer:.3f} {self.unit}, {self.ratio:.2f} times "
            f"(at least {self.required:g})"
        )
