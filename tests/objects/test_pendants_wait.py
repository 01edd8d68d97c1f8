# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading a frame imports only the post of the controller that it names: all posts take as long to
import as numpy."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize(
    "words, posts", [("100 0 -3 0 90 0", []), ("kuka 100 0 -3 0 90 0", ["kuka"])]
)
def test_a_pose_imports_the_post_that_it_names_alone(words, posts):
    lines = [
        "import sys",
        "from freecad_am.batch import host",
        "host.find_freecad()",
        "from freecad_am.objects.fields import pendants",
        f"pendants.plain('x at {words} carries y', 'here')",
        f"pendants.named({words.split()!r})",
        "loaded = [name.split('.') for name in sys.modules if name.startswith('freecad_am.posts.')]",
        "print(sorted(name[2] for name in loaded if name[3:] == ['post']))",
    ]
    process = subprocess.run(
        [sys.executable, "-c", "\n".join(lines)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    assert process.stdout.strip() == str(posts)
