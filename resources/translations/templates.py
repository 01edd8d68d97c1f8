# SPDX-License-Identifier: LGPL-2.1-or-later
"""Templates of the messages that the code makes, read from its syntax trees.

An f-string gives its text with the places {0}, {1} and so on; one with words that depend on a condition gives a template for
each case. Followed are arguments that a function passes on to a message, values that functions return, local variables and
constants.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from itertools import product
from string import Formatter

from sources import ROOT, Code, Function, Module, assigned, called, calls_in, walked

# what of a call is told to the user: positions of its arguments
MAKERS: dict[str, set[int]] = {
    "AmError": {1, 2}, "InputError": {1, 2}, "InfeasibleError": {1, 2}, "Issue": {2}, "report": {1}, "progress": {1},
    "Band": {0}, "Row": {0, 3},
    "Patch": {3}, "Chart": {0}, "Quantity": {0}, "Curve": {0}, "Entry": {0},
    "Promise": {0, 1}, "Proposal": {2}, "carry_out": {2}, "on_controller": set(range(8)),
}
PROPERTY = "Message"  # of stages: what it is set to is told
KEYWORDS = {"message", "where", "lacking", "text", "label", "short", "name"}
_MOST_CASES = 16
_DEPTH = 11
_WORD = re.compile(r"[^\W\d_]{2,}")
# neither a text nor what holds some
_OPAQUE = {"len", "round", "float", "int", "sum", "max", "min", "abs", "degrees", "repr", "type", "set", "range"}

Part = str | ast.expr  # literal text, or what is put in


class Templates:
    """All templates of some code."""

    def __init__(self, code: Code, titles: tuple[str, ...] = ()) -> None:
        """titles: files where single words are told too."""
        self.code, self.titles = code, titles
        self.makers = {name: set(positions) for name, positions in MAKERS.items()}
        self.found: dict[str, str] = {}  # template: where it is first made
        self._seen: set[tuple[int, int]] = set()
        while self._learn():
            pass
        for module in code.modules:
            for node, texts in self._telling(module):
                for text in texts:
                    self._collect(text, module, module.around[id(node)], _DEPTH)

    # ---- which functions pass on a message

    def _telling(self, module: Module) -> Iterator[tuple[ast.AST, list[ast.expr]]]:
        """The nodes that tell something, calls and settings of a stage's message, with what they tell."""
        for node in _tellers(module.tree):
            if isinstance(node, ast.Assign):
                yield node, [node.value]
            elif called(node) in self.makers:
                yield node, self._told(node)

    def _told(self, call: ast.Call) -> list[ast.expr]:
        """The arguments of a call that are told."""
        positions = self.makers[called(call)]
        return [argument for at, argument in enumerate(call.args) if at in positions] + [
            keyword.value for keyword in call.keywords if keyword.arg in KEYWORDS
        ]

    def _learn(self) -> bool:
        """Add functions that put a parameter into a message; False when there are no more."""
        before = sum(map(len, self.makers.values()))
        for module in self.code.modules:
            for teller, texts in self._telling(module):
                function = module.around[id(teller)]
                if function is None:
                    continue
                names = [one.arg for one in function.args.args]
                names = names[1:] if names[:1] in (["self"], ["cls"]) else names
                used = {node.id for text in texts for node in ast.walk(text) if isinstance(node, ast.Name)}
                for at, name in enumerate(names):
                    if name in used and (self._is_text(function, name) or _is_list(function, name)):
                        self.makers.setdefault(function.name, set()).add(at)
        return sum(map(len, self.makers.values())) > before

    @staticmethod
    def _is_text(function: Function, name: str) -> bool:
        note = next(one.annotation for one in function.args.args if one.arg == name)
        return isinstance(note, ast.Name) and note.id == "str"

    # ---- what a told expression can be

    def _collect(self, node: ast.AST | None, module: Module, function: Function | None, depth: int) -> None:
        if node is None or depth == 0 or (id(node), depth) in self._seen:
            return
        self._seen.add((id(node), depth))
        if isinstance(node, (ast.Constant, ast.JoinedStr, ast.BinOp)):
            for case in self._cases(node, function):
                self._add(case, module)
                for part in case:
                    if not isinstance(part, str):
                        self._collect(part, module, function, depth - 1)
        elif isinstance(node, ast.Call):
            self._collect_call(node, module, function, depth)
        elif isinstance(node, ast.Name):
            self._collect_name(node.id, module, function, depth)
        elif isinstance(node, ast.Attribute):
            for where, value in self.code.constants.get(node.attr, []):
                self._collect(value, where, None, depth - 1)
        elif isinstance(node, ast.Subscript):
            self._collect(node.value, module, function, depth - 1)
        elif isinstance(node, ast.IfExp):
            self._collect(node.body, module, function, depth - 1)
            self._collect(node.orelse, module, function, depth - 1)
        elif isinstance(node, (ast.ListComp, ast.GeneratorExp, ast.SetComp)):
            self._collect(node.elt, module, function, depth - 1)
            for loop in node.generators:
                self._collect(loop.iter, module, function, depth - 1)
        elif isinstance(node, ast.Dict):
            for part in (*node.keys, *node.values):
                self._collect(part, module, function, depth - 1)
        elif isinstance(node, (ast.Tuple, ast.List, ast.Set, ast.BoolOp, ast.Starred)):
            for child in ast.iter_child_nodes(node):
                self._collect(child, module, function, depth - 1)

    def _collect_call(self, node: ast.Call, module: Module, function: Function | None, depth: int) -> None:
        name = called(node)
        if name == "format" and isinstance(node.func, ast.Attribute) and isinstance(node.func.value, ast.Constant):
            self._add(_formatted(node.func.value.value), module)
            for argument in node.args:
                self._collect(argument, module, function, depth - 1)
            return
        if name in _OPAQUE or name in self.makers:
            return
        if isinstance(node.func, ast.Attribute):
            self._collect(node.func.value, module, function, depth - 1)  # text.strip(), names.get(key)
            if name in ("join", "get"):
                for argument in node.args:
                    self._collect(argument, module, function, depth - 1)
        for where, made in self.code.functions.get(name, []):
            for statement in walked(made):
                if isinstance(statement, (ast.Return, ast.Yield)) and where.around.get(id(statement)) is made:
                    self._collect(statement.value, where, made, depth - 1)

    def _collect_name(self, name: str, module: Module, function: Function | None, depth: int) -> None:
        own = [] if function is None else _values(name, function)
        for value in own:
            self._collect(value, module, function, depth - 1)
        filled = [] if function is None else list(self._filled(name, function))
        for where, other, parameter in filled:
            self._collect_name(parameter, where, other, depth - 1)
        if not own and not filled:
            for where, value in self.code.constants.get(name, []):
                self._collect(value, where, None, depth - 1)

    def _filled(self, name: str, function: Function) -> Iterator[tuple[Module, Function, str]]:
        """The functions that get a list to put texts into, and what they call it."""
        for call in calls_in(function):
            for at, argument in enumerate(call.args):
                if getattr(argument, "id", "") == name:
                    for where, other in self.code.functions.get(called(call), []):
                        names = [one.arg for one in other.args.args]
                        if at < len(names) and other is not function and _is_list(other, names[at]):
                            yield where, other, names[at]

    # ---- the cases of a text

    def _cases(self, node: ast.expr, function: Function | None) -> list[list[Part]]:
        """The texts that an expression can be, each as literal parts and what is put in between."""
        if isinstance(node, ast.Constant):
            return [_formatted(node.value)] if isinstance(node.value, str) else []
        if isinstance(node, ast.JoinedStr):
            found: list[list[Part]] = [[]]
            for part in node.values:
                inner = part.value if isinstance(part, ast.FormattedValue) else part
                plain = not isinstance(part, ast.FormattedValue) or (part.format_spec is None and part.conversion == -1)
                cases = (self._words(inner, function) if plain else None) or [[inner]]
                found = [[*before, *case] for before, case in product(found, cases)]
                if len(found) > _MOST_CASES:
                    raise ValueError(f"too many cases in {ast.unparse(node)}")
            return found
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
            left = self._words(node.left, function) or self._cases(node.left, function) or [[node.left]]
            right = self._words(node.right, function) or self._cases(node.right, function) or [[node.right]]
            return [[*one, *other] for one, other in product(left, right)]
        return []

    def _words(self, node: ast.expr, function: Function | None) -> list[list[Part]] | None:
        """The cases of what is put in, where it is but words chosen by a condition; else None."""
        if isinstance(node, (ast.Constant, ast.JoinedStr)):
            return self._cases(node, function) or None
        if isinstance(node, ast.IfExp):
            body, other = self._words(node.body, function), self._words(node.orelse, function)
            return None if body is None or other is None else body + other
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult) and isinstance(node.left, ast.Constant):
            return [[node.left.value], [""]] if isinstance(node.left.value, str) else None
        if isinstance(node, ast.Name) and function is not None:
            values = _values(node.id, function)
            if values and node.id not in [one.arg for one in function.args.args]:
                cases = [self._words(value, function) if not isinstance(value, ast.Name) else None for value in values]
                if all(cases) and sum(map(len, filter(None, cases))) <= 4:
                    return [case for some in cases if some for case in some]
        return None

    def _add(self, case: list[Part], module: Module) -> None:
        texts: list[str] = []
        count = 0
        for part in filter(None, case):
            if isinstance(part, str):
                texts.append(part.replace("{", "{{").replace("}", "}}"))
            elif not texts or texts[-1] != f"{{{count - 1}}}":  # two places side by side cannot be told apart
                texts.append(f"{{{count}}}")
                count += 1
        template = "".join(texts).strip()
        title = str(module.path).endswith(self.titles) and template.isalpha()
        if title or says_something(template):
            self.found.setdefault(template, module.path.relative_to(ROOT).as_posix())


@cache
def _tellers(tree: ast.AST) -> tuple[ast.Call | ast.Assign, ...]:
    """What may tell something: all calls, and settings of a stage's message."""
    return tuple(
        node for node in walked(tree) if isinstance(node, ast.Call)
        or (isinstance(node, ast.Assign) and any(getattr(target, "attr", "") == PROPERTY for target in node.targets))
    )


def _formatted(text: str) -> list[Part]:
    """The parts of a constant, which may be meant for `format`."""
    if not re.search(r"\{\w*(:[^{}]*)?\}", text):
        return [text]
    found: list[Part] = []
    for literal, field, _, _ in Formatter().parse(text):
        found += [literal] if literal else []
        found += [ast.Name(field or "")] if field is not None else []
    return found


def _values(name: str, function: Function) -> list[ast.expr]:
    """What a local variable is given."""
    return _given(function).get(name, [])


@cache
def _given(function: Function) -> dict[str, list[ast.expr]]:
    """What all local variables are given: by statements, then by loops, and by calls that add to a list."""
    found: dict[str, list[ast.expr]] = {}
    for node in walked(function):
        if isinstance(node, ast.stmt):
            for name, value in assigned(node):
                found.setdefault(name, []).append(value)
    for node in walked(function):
        if isinstance(node, (ast.For, ast.comprehension)):
            for name in {one.id for one in ast.walk(node.target) if isinstance(one, ast.Name)}:
                found.setdefault(name, []).append(node.iter)
        elif isinstance(node, ast.Call) and node.args and called(node) in ("append", "insert", "extend"):
            holder = getattr(node.func, "value", None)
            if isinstance(holder, ast.Name):
                found.setdefault(holder.id, []).append(node.args[-1])
    return found


def _is_list(function: Function, name: str) -> bool:
    """Whether a parameter is a list of texts."""
    note = next(one.annotation for one in function.args.args if one.arg == name)
    return note is not None and ast.unparse(note) == "list[str]"


def says_something(template: str) -> bool:
    """Whether a text is several words, and not the name of something."""
    return len(_WORD.findall(re.sub(r"\{\d+\}", " ", template))) >= 2 and " " in template.strip()
