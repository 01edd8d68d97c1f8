# SPDX-License-Identifier: LGPL-2.1-or-later
"""The code as syntax trees, and where its functions, constants and classes are."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "freecad_am"

Function = ast.FunctionDef


def children(node: ast.AST) -> Iterator[ast.AST]:
    """The nodes right below one, without the contexts of names (Load, Store), half of all nodes, which say nothing here."""
    for name in node._fields:
        value = getattr(node, name, None)
        if isinstance(value, ast.AST):
            if name != "ctx":
                yield value
        elif isinstance(value, list):
            yield from (one for one in value if isinstance(one, ast.AST))


@cache
def walked(node: ast.AST) -> tuple[ast.AST, ...]:
    """All nodes of a tree or function, found once: the same are looked at again and again."""
    found = [node]
    for one in found:  # which grows meanwhile
        found.extend(children(one))
    return tuple(found)


@cache
def calls_in(node: ast.AST) -> tuple[ast.Call, ...]:
    """All calls in a tree or function."""
    return tuple(one for one in walked(node) if isinstance(one, ast.Call))


class Module:
    """A file: its tree, and for each node the function it stands in."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.tree = ast.parse(path.read_text(encoding="utf-8"))
        self.functions = [node for node in walked(self.tree) if isinstance(node, Function)]
        self.around: dict[int, Function | None] = {id(self.tree): None}
        for node in walked(self.tree):
            function = node if isinstance(node, Function) else self.around[id(node)]
            for child in children(node):
                self.around[id(child)] = function


class Code:
    """Several files, and what they define, by name."""

    def __init__(self, paths: list[Path]) -> None:
        self.modules = [Module(path) for path in sorted(paths)]
        self.functions: dict[str, list[tuple[Module, Function]]] = defaultdict(list)
        self.constants: dict[str, list[tuple[Module, ast.expr]]] = defaultdict(list)
        for module in self.modules:
            for function in module.functions:
                self.functions[function.name].append((module, function))
            for holder in [
                module.tree,
                *(node for node in module.tree.body if isinstance(node, ast.ClassDef)),
            ]:
                for statement in holder.body:
                    for name, value in assigned(statement):
                        self.constants[name].append((module, value))


def assigned(statement: ast.stmt) -> Iterator[tuple[str, ast.expr]]:
    """Names that a statement gives values, or entries, with those; of pairs one by one."""
    if isinstance(statement, (ast.AnnAssign, ast.AugAssign)):
        if isinstance(statement.target, ast.Name) and statement.value is not None:
            yield statement.target.id, statement.value
    elif isinstance(statement, ast.Assign):
        for target in statement.targets:
            if isinstance(target, ast.Name):
                yield target.id, statement.value
            elif isinstance(target, ast.Subscript) and isinstance(target.value, ast.Name):
                yield target.value.id, ast.Dict([target.slice], [statement.value])
            elif isinstance(target, ast.Tuple):
                values = (
                    statement.value.elts
                    if isinstance(statement.value, ast.Tuple)
                    else [statement.value]
                )
                values = (
                    values
                    if len(values) == len(target.elts)
                    else [statement.value] * len(target.elts)
                )
                for one, value in zip(target.elts, values, strict=True):
                    if isinstance(one, ast.Name):
                        yield one.id, value


def called(node: ast.Call) -> str:
    """The bare name of what is called."""
    return node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")


def files(*folders: str) -> list[Path]:
    """The files of the package in these folders, or with these names."""
    found: list[Path] = []
    for name in folders:
        path = PACKAGE / name
        found += sorted(path.rglob("*.py")) if path.is_dir() else [path]
    return found
