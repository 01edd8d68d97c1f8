# SPDX-License-Identifier: LGPL-2.1-or-later
"""Find the drawings of previews in the scene."""

from freecad_am.gui.views.preview import NAME


def drawn_by_previews(person, kind):
    """Return the Coin nodes of a kind in the order of drawing; None without a preview."""
    from pivy import coin

    search = coin.SoSearchAction()
    search.setName(NAME)
    search.setSearchingAll(True)
    search.apply(person.gui.activeDocument().activeView().getSceneGraph())
    if search.getPath() is None:
        return None
    inside = coin.SoSearchAction()
    inside.setType(getattr(coin, kind).getClassTypeId())
    inside.setInterest(coin.SoSearchAction.ALL)
    inside.setSearchingAll(True)
    inside.apply(search.getPath().getTail())
    paths = inside.getPaths()
    return [paths[k].getTail() for k in range(paths.getLength())]
