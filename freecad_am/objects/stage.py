# SPDX-License-Identifier: LGPL-2.1-or-later
"""Base of stages: parameters as properties, a status, and a stored result with its input key.

`renew` computes a stage and raises core errors. FreeCAD's recompute calls `execute`, which turns
errors into the status, a message and one line on the console. Results are read back on first use.

Computation has two steps: `prepare` reads the document and returns the work, which does not touch
the document. So the work can run in another thread while the window stays responsive, and can be
cancelled at any time.
"""

from __future__ import annotations

import contextlib
import importlib
import time
from collections.abc import Iterator
from contextvars import ContextVar
from typing import Any, ClassVar

import FreeCAD as App

from ..core.issues import ERROR, AmError, InfeasibleError, InputError, Issue, Text, Word, has_errors
from ..core.one_thread import one_thread
from . import staleness
from .fields import properties, rows
from .fields.properties import HIDDEN, OUTPUT, READ_ONLY
from .results import fingerprints, store
from .results.findings import first_message, issues_of, reason_of, say, store_issues
from .results.fingerprints import SCHEMA_VERSION
from .results.store import Stored
from .shapes.containers import broken_link, is_there
from .shapes.file_links import missing_files
from .stage_parts import Link, Outcome, Section, Work
from .staleness import FAILED, INFEASIBLE, STALE, STATUSES, UP_TO_DATE
from .work import hooks, progress

CLASS_PROPERTY = "StageClass"
_RESULT = "Result"
_is_deferred: ContextVar[bool] = ContextVar("is_deferred", default=False)


class Stage(Stored):
    """Base class of stage proxies. Class paths are a file format. Only properties are saved."""

    kind: ClassVar[str] = ""
    sections: ClassVar[tuple[Section, ...]] = ()
    links: ClassVar[tuple[Link, ...]] = ()
    figures: ClassVar[tuple[tuple[str, str, str], ...]] = ()  # property, FreeCAD type, help
    _busy = False
    changes = 0  # number of input changes, counted by `staleness`
    was_run = False  # whether FreeCAD's last recompute ran the stage

    def __init__(self, obj: Any) -> None:
        obj.Proxy = self
        self.complete(obj)
        hooks.attach(obj)

    # ---- overridden by stage classes

    def prepare(self, obj: Any) -> Work:
        """Read the inputs and return the work, which computes the result without the document.

        `prepare` and the work raise InputError and InfeasibleError.
        """
        raise NotImplementedError

    def further_inputs(self, obj: Any) -> list[str]:
        """Return fingerprints of inputs that are neither parameters nor linked stages."""
        return []

    # ---- properties

    def complete(self, obj: Any) -> None:
        """Add missing properties to the object. This also migrates old documents."""
        staleness.watch()
        have = set(obj.PropertiesList)

        def add(type_name: str, name: str, group: str, help: str, attributes: int = 0) -> bool:
            if name not in have:
                obj.addProperty(type_name, name, group, help, attributes)
            return name not in have

        for link in self.links:
            # global links reach parts and bodies nested in assemblies
            add(
                link.type_name if link.kind else f"{link.type_name}Global",
                link.name,
                "Inputs",
                link.help,
            )
        for section in self.sections:
            properties.add(obj, section.cls, section.group)
        if add(
            "App::PropertyEnumeration",
            "Status",
            _RESULT,
            "State of the result: up to date, stale, infeasible or failed.",
            READ_ONLY | OUTPUT,
        ):
            obj.Status = list(STATUSES)
            obj.Status = STALE
        add(
            "App::PropertyString",
            "Message",
            _RESULT,
            "The problem and the remedy.",
            READ_ONLY | OUTPUT,
        )
        for name, type_name, help in self.figures:
            add(type_name, name, _RESULT, help, READ_ONLY | OUTPUT)
        hidden = HIDDEN | OUTPUT
        add("App::PropertyString", "Issues", _RESULT, "Findings, as JSON.", hidden)
        add(
            "App::PropertyString",
            "Texts",
            _RESULT,
            "Template and values of message and findings, as JSON.",
            hidden,
        )
        add(
            "App::PropertyString",
            "Key",
            _RESULT,
            "Fingerprint of the inputs the result was made from.",
            hidden,
        )
        add("App::PropertyFloat", "Seconds", _RESULT, "Computing time.", hidden)
        add("App::PropertyFloatList", "ResultData", _RESULT, "Arrays of the result.", hidden)
        add("App::PropertyString", "ResultLayout", _RESULT, "Contents of the arrays.", hidden)
        if add(
            "App::PropertyString",
            CLASS_PROPERTY,
            _RESULT,
            "Type of the object, in case its proxy is lost.",
            hidden,
        ):
            setattr(obj, CLASS_PROPERTY, f"{type(self).__module__}.{type(self).__name__}")
        if add(
            "App::PropertyInteger", "SchemaVersion", _RESULT, "Version of the properties.", hidden
        ):
            obj.SchemaVersion = SCHEMA_VERSION

    def parameters(self, obj: Any, cls: type) -> Any:
        """Return the parameters of class `cls` or a subclass.

        Raises InputError, naming Label and property, for an invalid value.
        """
        section = next(section for section in self.sections if issubclass(section.cls, cls))
        return properties.read(obj, section.cls, section.prefix)

    # ---- computing

    def renew(self, obj: Any, force: bool = False) -> Any:
        """Compute and store the result if an input has changed or `force` is set; return it.

        Raises AmError; the object reports the error and keeps its last result. Raises Cancelled if
        the user cancels or the object is deleted during computation; the last result is kept too.
        """
        if hooks.carrying():
            raise InputError(
                "BUSY",
                obj.Label,
                "another computation is running; wait for its end, or cancel it",
            )
        try:
            with one_thread(), progress.kernel_faults(obj):
                key = self.key(obj)
                refused = obj.Status != INFEASIBLE and has_errors(
                    issues_of(obj)
                )  # the issues were stored for other inputs
                outdated = (force or refused or key != obj.Key) and self._compute(obj, key)
            issues_found = issues_of(obj)
            with self._own_changes():
                if outdated:
                    say(obj, STALE, "an input changed during the computation; recompute the object")
                else:
                    say(
                        obj,
                        INFEASIBLE if has_errors(issues_found) else UP_TO_DATE,
                        first_message(issues_found),
                    )
        except progress.Cancelled:
            if is_there(obj) and key != obj.Key:
                with self._own_changes():
                    say(obj, STALE, "cancelled; recompute the object")
            raise
        except InfeasibleError as error:
            with self._own_changes():
                store_issues(obj, error.issues or (Issue(ERROR, error.code, error.message),))
                say(obj, INFEASIBLE, error.sentence)
            raise
        except BaseException as error:
            with self._own_changes():
                say(
                    obj,
                    FAILED,
                    error.sentence
                    if isinstance(error, AmError)
                    else f"{type(error).__name__}: {error}",
                )
            raise
        return self.value(obj)

    def _compute(self, obj: Any, key: str) -> bool:
        """Compute and store the result. Return whether the inputs changed during computation."""
        started, changes, label = time.perf_counter(), self.changes, obj.Label
        work = self.prepare(obj)

        def packed() -> tuple[Outcome, list[float], str]:
            with progress.memory_faults(label):
                outcome = work()
                return outcome, *store.pack(outcome.value, key)

        try:
            packed_result = hooks.carry_out(packed, obj.Label)
        except AmError:
            if is_there(obj):
                raise
            raise progress.Cancelled from None
        if not is_there(obj):
            raise progress.Cancelled
        with self._own_changes():
            self._store(obj, *packed_result, key, time.perf_counter() - started)
        return self.changes != changes

    @contextlib.contextmanager
    def _own_changes(self) -> Iterator[None]:
        """Within the context, changes of the object do not make stages stale."""
        self._busy = True
        try:
            yield
        finally:
            self._busy = False

    def key(self, obj: Any) -> str:
        """Return the fingerprint of the inputs. Raises InputError for a missing or failed input."""
        return fingerprints.key_of_inputs(self, obj, fingerprints.key_of_stage)

    def linked(self, obj: Any) -> dict[str, Any]:
        """Return the linked stages by property name, as lists for multi-object links.

        Each linked stage must have the right kind and a result.
        """
        if missing := self.missing(obj):
            raise InputError("NO_INPUT", obj.Label, missing)
        return {link.name: checked(obj, link) for link in self.links if link.kind}

    def missing(self, obj: Any) -> str:
        """Return a remedy for a missing required input, '' if no input is missing."""
        for link in self.links:
            if link.required and not getattr(obj, link.name):
                return Text("{} is missing; choose {}", link.name, link.help_phrase)
            if broken := broken_link(getattr(obj, link.name)):
                return _lost_link(obj, broken, link.name)
        return rows.broken(obj)

    def _store(
        self, obj: Any, outcome: Outcome, floats: list[float], text: str, key: str, seconds: float
    ) -> None:
        obj.ResultData, obj.ResultLayout, obj.Seconds = floats, text, seconds
        store_issues(obj, outcome.issues)
        for name, figure in outcome.figures:
            setattr(obj, name, figure)
        self._kept = (key, outcome.value)
        obj.Key = key  # set last, because views redraw when the key changes

    def say_failed(self, obj: Any, error: AmError) -> None:
        """Report why the stage will fail, before its inputs are computed."""
        with self._own_changes():
            say(obj, FAILED, error.sentence)

    # ---- called by FreeCAD

    def execute(self, obj: Any) -> None:
        """Compute the stage; report errors in the status and in one line on the console.

        A stage with a stale input, such as a cancelled stage, waits for the input.
        """
        self.was_run = True
        if _is_deferred.get():
            return
        stale = next(
            (linked.Label for linked in self._linked_stages(obj) if linked.Status == STALE), ""
        )
        if stale:
            with self._own_changes():
                say(obj, STALE, Text("waits for {}; recompute the object", stale))
            return
        try:
            self.renew(obj)
        except AmError as error:
            App.Console.PrintError(error.line() + "\n")
        except progress.Cancelled:
            if is_there(obj):
                App.Console.PrintWarning(f"{obj.Label}: cancelled\n")

    def _linked_stages(self, obj: Any) -> list[Any]:
        linked = [
            (getattr(obj, link.name) if link.many else [getattr(obj, link.name)])
            for link in self.links
            if link.kind
        ]
        return [entry for entries in linked for entry in entries if stage_of(entry) is not None]

    def mustExecute(self, obj: Any) -> bool:
        """Whether the next recompute must run the stage: stale and failed stages are run."""
        return obj.Status in (STALE, FAILED)

    def onChanged(self, obj: Any, name: str) -> None:
        """Mark dependent stages as stale at once."""
        if not self._busy and "Status" in obj.PropertiesList and name not in staleness.RESULTS:
            staleness.changed(obj, name)

    def onDocumentRestored(self, obj: Any) -> None:
        """Migrate an old document and attach the view. Report inputs that a copied stage lacks."""
        with self._own_changes():
            self.complete(obj)
            if missing := self.missing(obj):
                say(obj, FAILED, missing)
        hooks.attach(obj)

    def dumps(self) -> None:
        """Save nothing: all data is in properties."""

    def loads(self, state: Any) -> None:
        """Restore nothing: all data is in properties."""

    # FreeCAD up to 0.21.1 calls __getstate__ and __setstate__, later versions dumps and loads
    __getstate__ = dumps
    __setstate__ = loads


@contextlib.contextmanager
def deferred() -> Iterator[None]:
    """Within the context, a recompute runs shapes and expressions only; call `renew` per stage."""
    token = _is_deferred.set(True)
    try:
        yield
    finally:
        _is_deferred.reset(token)


def _lost_link(obj: Any, label: str, link: str) -> Text:
    """Return the remedy for a broken FreeCAD link as input; name the linked file if missing."""
    missing = missing_files(obj.Document)
    for linked in obj.Document.getObjectsByLabel(label):
        if linked.Name in missing:
            return Text(
                "{} links to {}, which does not exist; restore the file and open the document "
                "again, or choose another {}",
                label,
                missing[linked.Name],
                link,
            )
    return Text(
        "{} links to no object, as its target was deleted or is not loaded; choose another {}",
        label,
        link,
    )


def stage_of(obj: Any) -> Stage | None:
    """Return the stage proxy of an object, None if the object is not a stage."""
    proxy = getattr(obj, "Proxy", None)
    return proxy if isinstance(proxy, Stage) else None


def checked(obj: Any, link: Link) -> Any:
    """Return the linked stage (None if unset), or a list for a multi-object link.

    Each linked stage must have the right kind and a result. Raises InputError BAD_INPUT,
    INPUT_FAILED; raises InfeasibleError INPUT_INFEASIBLE.
    """
    linked = getattr(obj, link.name)
    return (
        [_checked(obj, link, entry) for entry in linked]
        if link.many
        else _checked(obj, link, linked)
    )


def _checked(obj: Any, link: Link, linked: Any) -> Any:
    if linked is None:
        return None
    stage = stage_of(linked)
    if stage is None or stage.kind != link.kind:
        article = "an" if link.kind[0] in "aeiou" else "a"
        raise InputError(
            "BAD_INPUT",
            f"{obj.Label}.{link.name}",
            "{} is not {} {}; choose another object",
            linked.Label,
            Word(article),
            link.kind,
        )
    if linked.Status == INFEASIBLE:
        why = Text("{} is infeasible: {}", linked.Label, reason_of(linked))
        raise InfeasibleError("INPUT_INFEASIBLE", obj.Label, why, issues=issues_of(linked))
    if linked.Status == FAILED or not linked.Key:
        raise InputError(
            "INPUT_FAILED",
            obj.Label,
            "waits for {}: {}",
            linked.Label,
            reason_of(linked) or "recompute the object",
        )
    return linked


# ---- Restore proxies lost because FreeCAD saved the document without the workbench installed
#
# If FreeCAD cannot import a proxy, it saves the object without the proxy. All other data, including
# the class of the proxy, is in properties.

_PACKAGE_PREFIX = __name__.rpartition(".")[0] + "."


def revive(document: Any) -> None:
    """Restore the lost stage proxies of a document."""
    for obj in document.Objects:
        if stage_of(obj) is None and CLASS_PROPERTY in obj.PropertiesList:
            cls = _stage_class(getattr(obj, CLASS_PROPERTY))
            if cls is not None:
                cls(obj)


def _stage_class(path: str) -> type[Stage] | None:
    """Return the stage class of a class path, None if it is not a stage of this package."""
    module, _, name = path.rpartition(".")
    if not module.startswith(_PACKAGE_PREFIX):
        return None
    try:
        candidate = getattr(importlib.import_module(module), name, None)
    except ImportError:
        return None
    return candidate if isinstance(candidate, type) and issubclass(candidate, Stage) else None
