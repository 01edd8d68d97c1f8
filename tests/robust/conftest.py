# SPDX-License-Identifier: LGPL-2.1-or-later
"""The small part, its job and the launcher of the tests of commands."""

from tests.batch.conftest import workshop  # noqa: F401
