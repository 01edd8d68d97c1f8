# SPDX-License-Identifier: LGPL-2.1-or-later
"""A link of the robot that touches something, in words."""

from __future__ import annotations

from ...core.kinematics.links.contact import BASE, DEPOSIT, OWN_PREFIX, PART, PLATFORM, TORCH
from ...core.kinematics.links.nozzle_body import NOZZLE
from .translation import tr


def link_touches(link: str, what: str) -> str:
    """link: as `ArmContact.links` has it; what: as `ArmContact.names` has it, a body by its own name."""
    names = {
        NOZZLE: tr("the nozzle"),
        PLATFORM: tr("the platform"),
        DEPOSIT: tr("the deposit"),
        TORCH: tr("the torch"),
    }
    names[BASE] = tr("the base")
    if what.startswith(OWN_PREFIX):
        names[what] = tr("the link of {axis}").format(axis=what[len(OWN_PREFIX) :])
    if " " in link:  # of positioner or track, by its own name
        return tr("{link} touches {what}").format(link=link, what=names.get(what, what))
    if link == BASE:
        return tr("the base touches {what}").format(what=names.get(what, what))
    if link == PART:
        return tr("the part touches {what}").format(what=names.get(what, what))
    if link == NOZZLE:
        return tr("the nozzle touches {what}").format(what=names.get(what, what))
    if link == TORCH:
        return tr("the torch touches {what}").format(what=names.get(what, what))
    return tr("the link of {axis} touches {what}").format(axis=link, what=names.get(what, what))
