# SPDX-License-Identifier: LGPL-2.1-or-later
"""Share planned toolpaths and joint paths between the tests of a process. A test that plans from
the same inputs as an earlier test gets a copy of its result. The key is the stage's fingerprint,
by which the product itself decides whether a result is current. A forced recompute is always
planned."""

import contextlib
import functools
import pickle
from unittest import mock

from freecad_am.objects import joint_path
from freecad_am.objects.joint_path import JointPath
from freecad_am.objects.toolpath import Toolpath

_made = {}


def _inputs(stage, obj):
    """Return all that a result depends on: the inputs, the names in its messages, and whether
    remedies are searched for. Return None if the stage must be planned."""
    if not hasattr(obj, "OutListRecursive"):  # a draft of a panel has no inputs to compare
        return None
    key = stage.key(obj)
    if key == obj.Key:
        return None
    labels = tuple(sorted((source.Name, source.Label) for source in (obj, *obj.OutListRecursive)))
    return type(stage).__name__, key, labels, joint_path.remedies


def share_results(prepare):
    """Replace the method `prepare` of a stage by one that plans once for equal inputs."""

    @functools.wraps(prepare)
    def prepared(stage, obj):
        work, inputs = prepare(stage, obj), _inputs(stage, obj)
        if inputs is None:
            return work

        def plan():
            if inputs in _made:
                return pickle.loads(_made[inputs])
            outcome = work()
            _made[inputs] = pickle.dumps(outcome)
            return outcome

        return plan

    return prepared


@contextlib.contextmanager
def share_plans():
    """Share results while this context is active."""
    with contextlib.ExitStack() as patches:
        for stage in (Toolpath, JointPath):
            patches.enter_context(mock.patch.object(stage, "prepare", share_results(stage.prepare)))
        yield
