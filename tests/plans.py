# SPDX-License-Identifier: LGPL-2.1-or-later
"""Toolpaths and joint paths planned once: what makes the same as another test of the same process has made, of the same
inputs, gets a copy of what came out then.

Stages that are alike have the same key, the fingerprint of all that they are made of, by which the product itself tells
whether a result is to be made anew. What is asked for by force is planned.
"""

import contextlib
import functools
import pickle
from unittest import mock

from freecad_am.objects import joint_path
from freecad_am.objects.joint_path import JointPath
from freecad_am.objects.toolpath import Toolpath

_made = {}


def _inputs(stage, obj):
    """What an outcome depends on: the inputs, the names in its messages, and whether remedies are looked for. None where it
    is to be made anew."""
    if not hasattr(obj, "OutListRecursive"):  # a draft of a panel
        return None
    key = stage.key(obj)
    if key == obj.Key:
        return None
    labels = tuple(sorted((one.Name, one.Label) for one in (obj, *obj.OutListRecursive)))
    return type(stage).__name__, key, labels, joint_path.remedies


def _keeping(prepare):
    """The method `prepare` of a stage, whose work is done once for the same inputs."""

    @functools.wraps(prepare)
    def prepared(stage, obj):
        work, inputs = prepare(stage, obj), _inputs(stage, obj)
        if inputs is None:
            return work

        def made():
            if inputs in _made:
                return pickle.loads(_made[inputs])
            outcome = work()
            _made[inputs] = pickle.dumps(outcome)
            return outcome

        return made

    return prepared


@contextlib.contextmanager
def kept():
    """Within it they are."""
    with contextlib.ExitStack() as patches:
        for stage in (Toolpath, JointPath):
            patches.enter_context(mock.patch.object(stage, "prepare", _keeping(stage.prepare)))
        yield
