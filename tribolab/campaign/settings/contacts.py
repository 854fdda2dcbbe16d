"""The contacts of a campaign: [contact], and [contact.NAME] for another ball or rubber."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from pydantic import ConfigDict

from tribolab.campaign.settings.fields import SomeText
from tribolab.campaign.settings.measured import Contact

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign
    from tribolab.campaign.settings.measured import Surface

# what [contact] states of its own rubber is not that of another modulus
_OF_THE_MODULUS = ("youngs_modulus_range", "modulus_file", "sweep", "modulus_unit")


class Contacts(Contact):
    """The cylinder or ball and the elastomer, as far as they are known.

    A table `[contact.NAME]` has the same keys for the runs with `contact = "NAME"`: a series of
    elastomers, several balls. What it leaves out is as in `[contact]`.
    """

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[SomeText, Contact]
    named_table: ClassVar[type[Contact]] = Contact

    @property
    def by_name(self) -> dict[str, Contact]:
        """Contacts by name, the one without a name ("") first, each with what it leaves out."""
        return {"": self} | {name: self._completed(own) for name, own in self.named.items()}

    @property
    def named(self) -> Mapping[str, Contact]:
        """The tables [contact.NAME] by name, as they are stated."""
        return self.__pydantic_extra__ or {}

    def _completed(self, own: Contact) -> Contact:
        stated = {name: getattr(self, name) for name in self.model_fields_set & _KEYS}
        if own.youngs_modulus is not None:
            stated = {name: v for name, v in stated.items() if name not in _OF_THE_MODULUS}
        return Contact(**stated | {name: getattr(own, name) for name in own.model_fields_set})


_KEYS = set(Contact.model_fields)


@dataclass(frozen=True)
class ContactPair:
    """A surface in one of the contacts: what a curve, its model and the report call a surface.

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
    """Return what a surface is called in a contact.

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
    """Return the contact that a surface is called by, see `ContactPair.label`."""
    return campaign.contact.by_name[_name_of_label(campaign, label)]


def contact_table(campaign: Campaign, label: str) -> str:
    """Return the table of the contact that a surface is called by, as the file writes it."""
    name = _name_of_label(campaign, label)
    return f"[contact.{name}]" if name else "[contact]"


def _name_of_label(campaign: Campaign, label: str) -> str:
    names = {pair.label: pair.contact_name for pair in contact_pairs(campaign)}
    return names.get(label, label if label in campaign.contact.named else "")
