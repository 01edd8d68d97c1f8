# SPDX-License-Identifier: LGPL-2.1-or-later
"""Proposed program names are accepted by the controller, with the digits of parts, and as close to
the label as possible."""

import random
import string

import pytest

from freecad_am.core.issues import InputError
from freecad_am.objects.fields.rows import name_for, proposed_name, refusal, taken_name
from freecad_am.posts import catalogue


@pytest.mark.parametrize("post", catalogue.NAMES)
def test_what_is_proposed_is_taken_with_the_digits_of_parts(post):
    rng, naming = random.Random(7), catalogue.load(post).NAMING
    labels = [
        "".join(
            rng.choice(string.ascii_letters + string.digits + " _-é")
            for _ in range(rng.randint(0, 40))
        )
        for _ in range(300)
    ]
    for label in [
        *labels,
        "CON",
        "con",
        "main",
        "MODULE",
        "DEF",
        "if",
        "9 lives",
        "Hémisphère n° 1",
    ]:
        name = name_for(label, post)
        assert refusal(name, post) == "" and len(name) <= naming.longest - naming.spare, (
            label,
            name,
        )
        assert naming.parts(name, 99)
        plain = proposed_name(label)
        assert name == plain or not naming.fits(plain)
        accepted_name = taken_name(label, post)
        assert refusal(accepted_name, post) == "" and (
            accepted_name == plain or refusal(plain, post)
        )


def test_a_long_label_is_cut_for_controllers_of_few_characters_alone():
    label = "Nozzle of the second stage"
    assert (
        name_for(label, "fanuc")
        == proposed_name(label)
        == name_for(label, "none")
        == name_for(label, "")
    )
    assert (
        name_for(label, "abb") == "NOZZLE_OF"
        and taken_name("Nozzle of it", "abb") == "NOZZLE_OF_IT"
    )
    assert (
        "more than 14 characters" in refusal(proposed_name(label), "abb")
        and refusal("1", "none") == ""
    )


def test_the_proposal_of_a_refusal_is_the_same():
    with pytest.raises(InputError) as error:
        catalogue.load("abb").program_name("a name of many characters", "name")
    assert (
        repr(catalogue.load("abb").NAMING.proposed("a name of many characters"))
        in error.value.message
    )
