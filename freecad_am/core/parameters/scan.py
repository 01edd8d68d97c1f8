# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters to fit layers to a scan of the substrate."""

from __future__ import annotations

from dataclasses import dataclass

from . import field as f

PREFIX = "substrate"


@dataclass(frozen=True)
class ScanParameters:
    """Allowed distance of the scanned surface from the plan, and how layers lead back to the plan."""

    scan_within: float = f.parameter(
        5.0,
        f.LENGTH,
        "Largest distance of the scan from the plan; a scan farther away is rejected as a scan "
        "of another part.",
        low=0.0,
        open_low=True,
        high=1000.0,
        advanced=True,
    )
    scan_band: float = f.parameter(
        0.2,
        f.RATIO,
        "Largest deviation of the local layer height where layers blend from the scan back to "
        "the plan, as a share of the layer height.",
        low=0.0,
        open_low=True,
        high=0.5,
        advanced=True,
    )
    after_layer: int | None = f.parameter(
        None,
        f.COUNT,
        "Layer after which the scan was made, counted from 0, so that the layers above are "
        "fitted to the scan; none: the scan shows the bare substrate.",
        low=0,
        optional=True,
        advanced=True,
    )

    def __post_init__(self) -> None:
        f.check(self, PREFIX)

    @property
    def first(self) -> int:
        """The number of the first layer that is fitted."""
        return 0 if self.after_layer is None else self.after_layer + 1
