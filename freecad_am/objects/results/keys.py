# SPDX-License-Identifier: LGPL-2.1-or-later
"""The key of a stage's inputs: the origin of a stored result, as a text that differs after any
change.
"""

from __future__ import annotations

import contextlib
import hashlib
from collections.abc import Callable, Iterator
from typing import Any

from ..fields import properties

SCHEMA_VERSION = 2  # version of the properties of stages


def key_of_inputs(stage: Any, obj: Any, input_key: Callable[[str, Any], str]) -> str:
    """The key of an object's parameters, of its linked stages by `input_key(link, object)`, and of
    further inputs of `stage`, its proxy. InputError for a missing or failed one.
    """
    texts = [type(stage).__name__, str(SCHEMA_VERSION)]
    for section in stage.sections:
        texts += properties.fingerprint(obj, section.cls)
    for link, linked in stage.linked(obj).items():
        stage_objects = linked if isinstance(linked, list) else [linked]
        texts += [
            input_key(link, stage_object)
            for stage_object in stage_objects
            if stage_object is not None
        ]
    return hashlib.sha256("\n".join(texts + stage.further_inputs(obj)).encode()).hexdigest()[:32]


def key_of_stage(link: str, linked: Any) -> str:
    """The complete key of a linked stage."""
    return str(linked.Key)


def is_of_earlier_version(obj: Any) -> bool:
    """Whether an earlier version of the properties computed a stage from the inputs that it has now."""
    return any(_key_in(version, obj) == obj.Key for version in range(1, SCHEMA_VERSION))


def _key_in(version: int, obj: Any) -> str:
    with _counted_as(version):
        return str(obj.Proxy.key(obj))


@contextlib.contextmanager
def _counted_as(version: int) -> Iterator[None]:
    """Keys as an earlier version made them."""
    global SCHEMA_VERSION
    current = SCHEMA_VERSION
    SCHEMA_VERSION = version
    try:
        yield
    finally:
        SCHEMA_VERSION = current
