"""Unknown or contradictory names in a campaign file: surfaces, media, instruments, contacts."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from typing import TYPE_CHECKING

from tribolab.campaign.settings.contact_pairs import contact_of_label, contact_pairs
from tribolab.campaign.settings.files import instrument_of
from tribolab.campaign.settings.problems import SettingsProblem
from tribolab.core.errors import ConfigError, TribolabError, nearest, shown
from tribolab.lubrication.viscosity import LIQUIDS, knows_liquid

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign
    from tribolab.campaign.settings.measured import Medium


def of_names(campaign: Campaign) -> list[SettingsProblem]:
    """Return the problems with names and values, e.g. names that are used but not declared."""
    problems = []
    surfaces = [surface.name for surface in campaign.surface]
    for number, name in enumerate(surfaces):
        if name in surfaces[:number]:
            problems.append(
                SettingsProblem(
                    ("surface", number, "name"), f"'{shown(name)}' is the name of a surface before"
                )
            )
    for number, surface in enumerate(campaign.surface):
        if surface.instrument is not None and (what := _instrument(campaign, surface.instrument)):
            problems.append(SettingsProblem(("surface", number, "instrument"), what))
    stated = [
        (("medium", name), quantity, medium)
        for name, medium in campaign.medium.items()
        for quantity in ("viscosity", "work_of_adhesion")
    ]
    moduli = [
        (("contact", *([name] if name else [])), "youngs_modulus", contact)
        for name, contact in campaign.contact.by_name.items()
    ]
    for where, name, table in [*stated, *moduli]:
        value, bounds = getattr(table, name), getattr(table, f"{name}_range")
        if bounds and not (value is not None and bounds[0] <= value <= bounds[1]):
            what = f"must go from below to above {name}"
            problems.append(SettingsProblem((*where, f"{name}_range"), what))
    problems += _of_liquids(campaign)
    problems += _of_theory(campaign)
    if not campaign.run and not any(surface.scans for surface in campaign.surface):
        what = 'is missing; add [[run]] with files = "...", or [[surface]] with scans = "..."'
        problems.append(SettingsProblem(("run",), what))
    for number, entry in enumerate(campaign.run):
        if entry.surface is not None and entry.surface not in surfaces:
            what = f"no [[surface]] is called '{shown(entry.surface)}'" + _hint(
                entry.surface,
                surfaces,
                f'add [[surface]] with name = "{shown(entry.surface)}" (its scans may be left out)',
            )
            problems.append(SettingsProblem(("run", number, "surface"), what))
        if entry.medium is not None and entry.medium not in campaign.medium:
            what = f"there is no [medium.{shown(entry.medium)}]" + _hint(
                entry.medium,
                campaign.medium,
                f"add [medium.{shown(_toml_key(entry.medium))}] (its keys may be left out)",
            )
            problems.append(SettingsProblem(("run", number, "medium"), what))
        if entry.contact is not None and entry.contact not in campaign.contact.named:
            what = f"there is no [contact.{shown(entry.contact)}]" + _hint(
                entry.contact,
                campaign.contact.named,
                f"add [contact.{shown(_toml_key(entry.contact))}] with what differs from [contact]",
            )
            problems.append(SettingsProblem(("run", number, "contact"), what))
        if entry.instrument is not None and (what := _instrument(campaign, entry.instrument)):
            problems.append(SettingsProblem(("run", number, "instrument"), what))
    return problems


def _of_liquids(campaign: Campaign) -> list[SettingsProblem]:
    """Return the problems with the media: unknown, or not liquid at the temperature."""
    problems = []
    for name, medium in campaign.medium.items():
        if medium.liquid is not None and not knows_liquid(medium.liquid):
            what = f"no liquid '{shown(medium.liquid)}' is known{nearest(medium.liquid, LIQUIDS)}"
            problems.append(SettingsProblem(("medium", name, "liquid"), what))
            continue
        if medium.flow_curve is not None:
            problems += _of_flow_curve(campaign, name, medium)
            continue
        try:
            campaign.viscosity_of(name)
        except TribolabError as error:
            key, _, what = str(error).partition(": ")
            problems.append(SettingsProblem(("medium", name, key), what))
    return problems


def _of_flow_curve(campaign: Campaign, name: str, medium: Medium) -> list[SettingsProblem]:
    """Return the problem with the flow curve of a medium, if there is one."""
    where, what = ("medium", name, "flow_curve"), ""
    if medium.viscosity is not None:
        what = "there is a viscosity as well; state one of them"
    else:
        try:
            campaign.flow_curve_of(name)
        except TribolabError as error:
            what = str(error)
        except OSError:
            what = f"there is no file {campaign.raw / str(medium.flow_curve)}"
    return [SettingsProblem(where, what)] if what else []


def _of_theory(campaign: Campaign) -> list[SettingsProblem]:
    """Return the problems of [model] and [rubber]: unknown names, a modulus stated twice."""
    wrong = []
    surfaces = [pair.label for pair in contact_pairs(campaign)]
    for name in campaign.model.together:
        if name not in surfaces:
            what = f"no [[surface]] is called '{shown(name)}'{nearest(name, surfaces)}"
            wrong.append(SettingsProblem(("model", "together"), what))
    if len({contact_of_label(campaign, name).geometry for name in campaign.model.together}) > 1:
        what = "a ball and a cylinder have no load in common; fit them alone"
        wrong.append(SettingsProblem(("model", "together"), what))
    for table, key, medium in (
        ("model", "dry_medium", campaign.model.dry_medium),
        ("rubber", "adhesion", campaign.rubber.adhesion),
    ):
        if medium is not None and medium not in campaign.medium:
            what = f"there is no [medium.{shown(medium)}]{nearest(medium, campaign.medium)}"
            wrong.append(SettingsProblem((table, key), what))
        elif medium is not None and not _binds(campaign.medium[medium]):
            what = f"[medium.{shown(medium)}] wants a work_of_adhesion above zero"
            wrong.append(SettingsProblem((table, key), what))
    rubber = campaign.rubber
    files = [contact.modulus_file for contact in campaign.contact.by_name.values()]
    file = next(filter(None, files), None)
    if rubber.prony_moduli and file is not None:
        what = "there is [contact] modulus_file as well; state one of them"
        wrong.append(SettingsProblem(("rubber", "prony_moduli"), what))
    if rubber.temperature is not None and file is None and not rubber.prony_moduli:
        what = "there is no modulus to shift; state [contact] modulus_file, or prony_moduli"
        wrong.append(SettingsProblem(("rubber", "temperature"), what))
    return wrong


def _binds(medium: Medium) -> bool:
    return medium.work_of_adhesion is not None and medium.work_of_adhesion > 0


def _hint(word: str, known: Iterable[str], cure: str) -> str:
    """Return a hint: the most similar declared name, or how to declare the word."""
    hint = nearest(word, known)
    return hint if "did you mean" in hint else f"{hint}; {cure}"


def _toml_key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else json.dumps(name, ensure_ascii=False)


def _instrument(campaign: Campaign, name: str) -> str:
    from tribolab.reading.dialect.find import load_dialect  # imported late for a quick start

    try:
        load_dialect(instrument_of(campaign, name))
    except ConfigError as error:
        return error.message_for("campaign")
    return ""
