# SPDX-License-Identifier: LGPL-2.1-or-later
"""The key of a stage's inputs: what a stored result was made from, as a text that is another one when any of it changes."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from typing import Any

from ..fields import properties

SCHEMA_VERSION = 2  # of the properties of all stages


def of_inputs(stage: Any, obj: Any, input_key: Callable[[str, Any], str]) -> str:
    """Of the parameters of an object, its linked stages by `input_key(link, object)`, and what else `stage`, its proxy, is
    made from. InputError for a missing or failed one."""
    texts = [type(stage).__name__, str(SCHEMA_VERSION)]
    for section in stage.sections:
        texts += properties.fingerprint(obj, section.cls)
    for link, linked in stage.linked(obj).items():
        some = linked if isinstance(linked, list) else [linked]
        texts += [input_key(link, one) for one in some if one is not None]
    return hashlib.sha256("\n".join(texts + stage.further_inputs(obj)).encode()).hexdigest()[:32]


def of_all(link: str, linked: Any) -> str:
    """The key of all that a linked stage gives to another one."""
    return str(linked.Key)
