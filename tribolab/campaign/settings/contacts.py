"""The contacts of a campaign: [contact], and [contact.NAME] for another ball or rubber."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from pydantic import ConfigDict

from tribolab.campaign.settings.fields import SomeText
from tribolab.campaign.settings.measured import Contact

# not inherited from [contact] by a contact with its own modulus: it is another rubber
_OF_THE_MODULUS = ("youngs_modulus_range", "modulus_file", "sweep", "modulus_unit")


class Contacts(Contact):
    """The cylinder or ball and the elastomer, as far as they are known.

    A table `[contact.NAME]` has the same keys for the runs with `contact = "NAME"`: a series of
    elastomers, several balls. Keys that it omits are taken from `[contact]`.
    """

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[SomeText, Contact]
    named_table: ClassVar[type[Contact]] = Contact

    @property
    def by_name(self) -> dict[str, Contact]:
        """Contacts by name, [contact] ("") first; missing keys are taken from [contact]."""
        return {"": self} | {name: self._completed(own) for name, own in self.named.items()}

    @property
    def named(self) -> Mapping[str, Contact]:
        """Tables [contact.NAME] by name, without the keys of [contact]."""
        return self.__pydantic_extra__ or {}

    def _completed(self, own: Contact) -> Contact:
        stated = {name: getattr(self, name) for name in self.model_fields_set & _KEYS}
        if own.youngs_modulus is not None:
            stated = {name: v for name, v in stated.items() if name not in _OF_THE_MODULUS}
        return Contact(**stated | {name: getattr(own, name) for name in own.model_fields_set})


_KEYS = set(Contact.model_fields)
