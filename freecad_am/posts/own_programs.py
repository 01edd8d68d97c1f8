# SPDX-License-Identifier: LGPL-2.1-or-later
"""Find our programs in a folder by their content, so that no other file is mistaken for one.

A main program begins with the remarks of our programs, contains its file name, and names its parts.
Links are not followed.
"""

from __future__ import annotations

import contextlib
import os
import re
import tempfile
from collections.abc import Mapping

# remarks that every main program begins with
OUR_REMARKS = ("Limits: ", "Travel speed ")
# file extension of main programs -> extension of their parts
PART_ENDINGS = {
    ".ls": ".ls",
    ".mpf": ".spf",
    ".ngc": ".ngc",
    ".script": ".script",
    ".jbi": ".jbi",
    ".mod": ".mod",
    ".src": ".src",
}
APPLICATION = (
    "{}.pjx",
    "{}.dtx",
    "start.pgx",
    "stop.pgx",
)  # files in the folder of a VAL 3 application or of one of its parts
# pattern of the name inside a program, by file extension; a renamed copy is not ours
_TITLES = {
    ".ls": r"/PROG\s+{}\s",
    ".mod": r"MODULE\s+{}\s",
    ".src": r"&ACCESS RVP\s+&REL 1\s+DEF {}\(\)",
}
_HEAD_LENGTH = 4096  # characters at the start of a program that contain its first remarks
_MAX_LENGTH = 1 << 20  # characters of a main program that are searched for part names


def programs(folder: str) -> dict[str, set[str]]:
    """Map each main program to its files and its parts' files, with names relative to the folder
    and forward slashes.
    """
    files_by_program: dict[str, set[str]] = {}
    files, folders = _entries(folder)
    for main in files:
        stem, ending = os.path.splitext(main)
        if ending.lower() in PART_ENDINGS:
            text = _text(os.path.join(folder, main))
            if _is_ours(text, stem, ending):
                files_by_program[main] = {main} | _parts(
                    text, stem, PART_ENDINGS[ending.lower()], files
                )
    for name in folders:
        inside = os.path.join(folder, name)
        own_files, subfolders = _entries(inside)
        if "start.pgx" in own_files and _is_ours(
            _text(os.path.join(inside, "start.pgx")), name, ".pgx"
        ):
            numbered = [
                part_name
                for part_name in subfolders
                if re.fullmatch(re.escape(name) + r"\d+", part_name)
            ]
            files_of = {
                part_name: _entries(os.path.join(inside, part_name))[0] for part_name in numbered
            }
            files_by_program[f"{name}/{name}.pjx"] = {
                f"{name}/{file}" for file in _application(name, own_files)
            } | {
                f"{name}/{part_name}/{file}"
                for part_name, part_files in files_of.items()
                for file in _application(part_name, part_files)
            }
    return files_by_program


def _is_ours(text: str, stem: str, ending: str) -> bool:
    start = (
        text.find("//INST") if ending.lower() == ".jbi" else 0
    )  # in a Yaskawa job, remarks follow the positions
    head = text[start : start + _HEAD_LENGTH] if start >= 0 else ""
    title = _TITLES.get(ending.lower())
    if title and not re.match(title.format(re.escape(stem)), text, re.IGNORECASE):
        return False
    return all(remark in head for remark in OUR_REMARKS)


def _application(name: str, files: list[str]) -> set[str]:
    """Return the files that belong to an application or to one of its parts."""
    return {form.format(name) for form in APPLICATION} & set(files)


def _parts(text: str, stem: str, ending: str, files: list[str]) -> set[str]:
    """Return the files of the parts that a main program names."""
    called = {
        name.lower() for name in re.findall(rf"\b{re.escape(stem)}\d+\b", text, re.IGNORECASE)
    }
    split = ((file, *os.path.splitext(file.lower())) for file in files)
    return {file for file, name, its in split if its == ending and name in called}


def _entries(folder: str) -> tuple[list[str], list[str]]:
    """Return the names of files and subfolders in a folder, without links."""
    files, folders = [], []
    try:
        with os.scandir(folder) as entries:
            for entry in entries:
                if entry.is_file(follow_symlinks=False):
                    files.append(entry.name)
                elif entry.is_dir(follow_symlinks=False):
                    folders.append(entry.name)
    except (OSError, ValueError):
        pass
    return sorted(files), sorted(folders)


def _text(path: str) -> str:
    try:
        with open(path, encoding="utf-8-sig", errors="replace") as stream:
            return stream.read(_MAX_LENGTH)
    except OSError:
        return ""


def write(folder: str, files: Mapping[str, bytes]) -> list[str]:
    """Write files (name with slashes -> content) into a folder and return their paths.

    Create the folder if needed, and remove parts of an earlier program with the same name. Each
    file is written completely or not at all. No file is written or removed through a link below the
    folder. Raises OSError.
    """
    os.makedirs(folder, exist_ok=True)
    earlier_programs = programs(folder)
    paths = [os.path.join(folder, *name.split("/")) for name in files]
    waiting: list[tuple[str, str]] = []
    try:
        for path, content in zip(paths, files.values(), strict=True):
            _refuse_links(path, folder)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            handle, temporary = tempfile.mkstemp(prefix=".unfinished-", dir=os.path.dirname(path))
            waiting.append((temporary, path))
            with os.fdopen(handle, "wb") as stream:
                stream.write(content)
            os.chmod(temporary, 0o666 & ~_umask())
        stale = set().union(
            *(earlier_programs[main] for main in files if main in earlier_programs)
        ) - set(files)
        for name in sorted(stale):
            _remove(os.path.join(folder, *name.split("/")), folder)
        while waiting:
            os.replace(*waiting[0])
            del waiting[0]
    finally:
        for temporary, _ in waiting:
            with contextlib.suppress(OSError):
                os.remove(temporary)
    return paths


def _refuse_links(path: str, folder: str) -> None:
    parent = os.path.dirname(path)
    while len(parent) > len(folder):
        if os.path.islink(parent):
            raise NotADirectoryError(
                20, "a link takes the place of a folder of the program", parent
            )
        parent = os.path.dirname(parent)


def _remove(path: str, folder: str) -> None:
    """Remove a file, and the part's folder if it becomes empty."""
    os.remove(path)
    parent = os.path.dirname(path)
    if len(parent) > len(folder) and not os.listdir(parent):
        os.rmdir(parent)


def _umask() -> int:
    now = os.umask(0o077)
    os.umask(now)
    return now
