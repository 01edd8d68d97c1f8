# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files are read in full or rejected, without allocating the size that a hostile file claims."""

import hashlib
import os
import tracemalloc

import pytest

from freecad_am.core.geometry.job_files import MB, digest, read_content
from freecad_am.core.issues import InputError


@pytest.mark.parametrize("size", [0, 1, MB - 1, MB, MB + 1, 2 * MB])
def test_all_bytes_and_their_digest(tmp_path, size):
    data = os.urandom(size)
    path = tmp_path / "data"
    path.write_bytes(data)
    assert read_content(path, 2, "BAD_FILE", "it") == data
    assert digest(path, 2, "BAD_FILE", "it") == hashlib.sha256(data).hexdigest()


@pytest.mark.parametrize("read", [read_content, digest])
def test_larger_files_are_refused_unread(tmp_path, read):
    """Larger files are rejected without reading them."""
    path = tmp_path / "data"
    with path.open("wb") as stream:
        stream.truncate(100_000 * MB)  # a sparse file that occupies no disk space
    tracemalloc.start()
    with pytest.raises(InputError, match="larger than 2 MB") as caught:
        read(path, 2, "BAD_FILE", "it")
    _, peak_memory = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert (caught.value.code, caught.value.where) == ("BAD_FILE", "it") and peak_memory < MB


@pytest.mark.parametrize("read", [read_content, digest])
def test_what_tells_no_size_is_read_up_to_the_limit(read, monkeypatch, tmp_path):
    """Kernel files report no size, so the limit applies to the bytes read."""
    path = tmp_path / "data"
    path.write_bytes(b"x" * (3 * MB))
    fstat = os.fstat

    def stat_without_size(descriptor):
        fields = list(fstat(descriptor))
        fields[6] = 0
        return os.stat_result(fields)

    monkeypatch.setattr(os, "fstat", stat_without_size)
    with pytest.raises(InputError, match="larger than 2 MB"):
        read(path, 2, "BAD_FILE", "it")
    monkeypatch.undo()
    assert read_content(path, 3, "BAD_FILE", "it") == b"x" * (3 * MB)


@pytest.mark.parametrize("read", [read_content, digest])
def test_devices_pipes_and_folders_are_refused(tmp_path, read):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", tmp_path, "/dev/zero"):
        with pytest.raises((InputError, IsADirectoryError)):
            read(path, 2, "BAD_FILE", "it")
