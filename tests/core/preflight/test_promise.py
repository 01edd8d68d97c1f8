# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures of promises as text."""

import pytest

from freecad_am.core.preflight.promise import Promise
from freecad_am.gui.in_language import in_language
from tests.told_in_french import table


@pytest.mark.parametrize(
    ("worst", "unit", "said", "in_french"),
    [
        (0.0, "points", "0 points (≤ 0)", "0 point (≤ 0)"),
        (1.0, "points", "1 point (≤ 0)", "1 point (≤ 0)"),
        (2.0, "points", "2 points (≤ 0)", "2 points (≤ 0)"),
        (0.0, "rapids", "0 rapids (≤ 0)", "0 rapide (≤ 0)"),
        (1.0, "rapids", "1 rapid (≤ 0)", "1 rapide (≤ 0)"),
        (12.0, "rapids", "12 rapids (≤ 0)", "12 rapides (≤ 0)"),
        (1.0, "mm", "1 mm (≤ 0)", "1 mm (≤ 0)"),
        (0.25, "", "0.25 (≤ 0)", "0.25 (≤ 0)"),
    ],
)
def test_what_is_counted_is_singular_or_plural_as_the_language_has_it(worst, unit, said, in_french):
    """Counted units are singular or plural according to the language."""
    figure = Promise("a", "b", False, worst, unit, 0.0).figure
    translations = table()
    assert (figure, in_language(figure, lambda template: translations.get(template, template))) == (
        said,
        in_french,
    )
