"""Pairs of a surface and a contact; curves, models and the report call each pair a surface."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign
    from tribolab.campaign.settings.measured import Contact, Surface


@dataclass(frozen=True)
class ContactPair:
    """A surface in one of the contacts; curves, models and the report call the pair a surface.

    Parameters
    ----------
    surface
        Table [[surface]].
    contact_name
        NAME of [contact.NAME]; "" is [contact].
    contact
        Its bodies.
    """

    surface: Surface
    contact_name: str
    contact: Contact

    @property
    def label(self) -> str:
        """Name of the surface, with that of the contact if it has one."""
        return pair_label(self.surface.name, self.contact_name)


def pair_label(surface: str, contact: str) -> str:
    """Return the name of a surface, followed by the name of its contact if it has one.

    Examples
    --------
    >>> pair_label("Sb-S", ""), pair_label("Sb-S", "soft")
    ('Sb-S', 'Sb-S, soft')
    """
    return ", ".join(name for name in (surface, contact) if name)


def contact_pairs(campaign: Campaign, used: Iterable[str] | None = None) -> list[ContactPair]:
    """Return the surfaces of a campaign, each once for every contact in which it was measured.

    Parameters
    ----------
    campaign
        From `load_campaign`.
    used
        Labels of the pairs that were measured; by default all are returned. A surface that is in
        none of them is returned in [contact].
    """
    known = None if used is None else set(used)
    found: list[ContactPair] = []
    for surface in campaign.surface:
        pairs = [ContactPair(surface, name, c) for name, c in campaign.contact.by_name.items()]
        found += [p for p in pairs if known is None or p.label in known] or pairs[:1]
    return found


def contact_of_label(campaign: Campaign, label: str) -> Contact:
    """Return the contact that belongs to a label, see `ContactPair.label`."""
    return campaign.contact.by_name[_name_of_label(campaign, label)]


def contact_table(campaign: Campaign, label: str) -> str:
    """Return the name of the contact table that belongs to a label, as in the campaign file."""
    name = _name_of_label(campaign, label)
    return f"[contact.{name}]" if name else "[contact]"


def _name_of_label(campaign: Campaign, label: str) -> str:
    names = {pair.label: pair.contact_name for pair in contact_pairs(campaign)}
    return names.get(label, label if label in campaign.contact.named else "")
