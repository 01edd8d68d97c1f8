# SPDX-License-Identifier: LGPL-2.1-or-later
"""Issues and errors: what is wrong, where, and the remedy.

A problem of a valid job (unreachable point, limit exceeded) is an `Issue` with its location.
Unusable input is an `InputError`. A user's mistake raises no other exception from this package.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from math import inf
from string import Formatter
from typing import Any

from .number_texts import number_text

ERROR, WARNING, NOTE = "error", "warning", "note"
MAX_RANGES = 6  # maximum number of layer ranges in the message of a merged issue


class Text(str):
    """An English sentence with its template and values, for translation.

    `Text("it has {} faces of {:.3g} mm", count, width)` behaves like the formatted string.
    `template` has numbered placeholders, '{0} faces of {1} mm', and `values` holds the formatted
    values. A value that is a Text keeps its template and values. Without values the text is used
    unchanged, including braces.
    """

    __slots__ = ("template", "values")
    template: str
    values: tuple[str, ...]

    def __new__(cls, text: str, *values: object) -> Text:
        parts: list[str] = []
        kept: list[str] = []
        for literal, value in _pieces(text, values) if values else [(text, None)]:
            parts.append(literal.replace("{", "{{").replace("}", "}}"))
            if value is not None:
                parts.append(f"{{{len(kept)}}}")
                kept.append(value)
        template = "".join(parts)
        made = super().__new__(cls, template.format(*kept))
        made.template, made.values = template, tuple(kept)
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        return (Text, (self.template, *self.values) if self.values else (str(self),))

    def __add__(self, other: str) -> Text:
        return Text("{}{}", self, other)

    def __radd__(self, other: str) -> Text:
        return Text("{}{}", other, self)

    @staticmethod
    def joined(between: str, texts: Iterable[str]) -> str:
        """Join any number of texts by nested pairs of '{0}, {1}'; '' for none."""
        some, pair = list(texts), f"{{}}{between}{{}}"
        while len(some) > 1:
            some = [
                Text(pair, *some[k : k + 2]) if k + 1 < len(some) else some[k]
                for k in range(0, len(some), 2)
            ]
        return some[0] if some else ""


def values_in(text: str) -> Iterator[str]:
    """Yield the values of a text and of nested texts; a plain string has none."""
    for value in getattr(text, "values", ()):
        yield value
        yield from values_in(value)


@dataclass(frozen=True)
class Word:
    """A word or phrase that the code selects, such as a plural.

    It becomes part of the template, not a value.
    """

    text: str


def _pieces(text: str, values: tuple[object, ...]) -> Iterator[tuple[str, str | None]]:
    """Yield the text before each placeholder and its value; None if no placeholder follows."""
    given = iter(values)
    for literal, place, form, conversion in Formatter().parse(text):
        if place is None:
            yield literal, None
            continue
        value = values[int(place)] if place else next(given)
        if isinstance(value, Word):
            yield literal, None
            inner = value.text
            yield from (
                _pieces(inner.template, inner.values)
                if isinstance(inner, Text)
                else [(inner, None)]
            )
        elif isinstance(value, Text) and not form and not conversion:
            yield literal, value
        else:
            yield literal, _write(repr(value) if conversion == "r" else value, form or "")


def _write(value: object, form: str) -> str:
    """Format a value; with a `g` form, numbers of ordinary size have no exponent."""
    if form.endswith("g") and isinstance(value, (int, float)):
        return number_text(value, form)
    return format(value, form)


@dataclass(frozen=True)
class Issue:
    """A problem of a job.

    `layer`, `bead` and `point` count from 0 and are None if they do not apply.
    """

    level: str
    code: str
    message: str
    layer: int | None = None
    bead: int | None = None
    point: int | None = None

    def as_dict(self) -> dict[str, Any]:
        """Return the issue as stored in report.json."""
        return asdict(self)

    @property
    def where(self) -> str:
        """Location in words, '' if there is none."""
        named = (("layer {}", self.layer), ("bead {}", self.bead), ("point {}", self.point))
        known = [(word, index) for word, index in named if index is not None]
        return (
            Text(" ".join(word for word, _ in known), *(index for _, index in known))
            if known
            else ""
        )


def summarised(issues: Iterable[Issue]) -> list[Issue]:
    """Merge all issues of the same kind into one issue for display; reports keep every issue.

    Parameters
    ----------
    issues
        Issues in any order. Two are of the same kind if level, code and message template agree.

    Returns
    -------
    list of Issue
        One issue per kind, in the order of first occurrence. A merged issue has the location of the
        worst issue, whose message has the largest leading number. Its message gives the count and
        the layers.
    """
    kinds: dict[tuple[str, str, str], list[Issue]] = {}
    for issue in issues:
        template = getattr(issue.message, "template", issue.message)
        kinds.setdefault((issue.level, issue.code, template), []).append(issue)
    return [_merged(same) for same in kinds.values()]


def _merged(issues: list[Issue]) -> Issue:
    """Merge issues of one kind at the location of the worst issue."""
    layers = sorted({issue.layer for issue in issues if issue.layer is not None})
    worst = max(issues, key=_leading_figure)
    if len(issues) == 1:
        return worst
    if len(layers) < 2:
        message = Text("{} (and {} similar findings)", worst.message, len(issues) - 1)
    else:
        message = Text(
            "{} findings in layers {}, of which the worst is: {}",
            len(issues),
            ranges(layers),
            worst.message,
        )
    return replace(worst, message=message)


def _leading_figure(issue: Issue) -> float:
    """Return the first numeric value of the message, -inf if there is none."""
    for value in getattr(issue.message, "values", ()):
        try:
            return float(value)
        except ValueError:
            continue
    return -inf


def ranges(numbers: Sequence[int]) -> str:
    """Format ascending numbers as ranges, `2 to 5, 9`.

    After MAX_RANGES ranges, give the count of the remaining numbers.
    """
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    words = [str(run[0]) if len(run) == 1 else f"{run[0]} to {run[-1]}" for run in runs]
    rest = sum(map(len, runs[MAX_RANGES:]))
    return ", ".join([*words[:MAX_RANGES], *([f"{rest} more"] if rest else [])])


def has_errors(issues: tuple[Issue, ...] | list[Issue]) -> bool:
    """Whether any issue is an error, so that no program may be written."""
    return any(issue.level == ERROR for issue in issues)


class AmError(Exception):
    """Base class of the errors that the package raises deliberately.

    `exit_status` is the exit status of the headless command.
    """

    exit_status = 1

    def __init__(self, code: str, where: str, message: str, *values: object) -> None:
        """Create the error; `values` fill the placeholders of the message, see Text."""
        self.code = code
        self.where = where
        self.message = Text(message, *values) if values else message
        self.sentence = Text("{}: {}", where, self.message)
        super().__init__(self.sentence)

    def line(self) -> str:
        """Return the line printed to stderr: error[CODE] where: problem and remedy."""
        return f"error[{self.code}] {self.where}: {self.message}"


class InputError(AmError):
    """The job, the part, a machine file or the usage is wrong; the message gives the remedy.

    `mended_by`: parameter values by key that fix the problem, if known.
    """

    exit_status = 2

    def __init__(
        self,
        code: str,
        where: str,
        message: str,
        *values: object,
        mended_by: Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(code, where, message, *values)
        self.mended_by = dict(mended_by or {})


class InfeasibleError(AmError):
    """A valid job is infeasible; `issues` gives every location."""

    exit_status = 3

    def __init__(
        self, code: str, where: str, message: str, *values: object, issues: tuple[Issue, ...] = ()
    ) -> None:
        super().__init__(code, where, message, *values)
        self.issues = issues
