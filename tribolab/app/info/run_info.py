"""Output of `tribolab info` on a run: sampling, columns, missing inputs and its second log."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from tribolab.app.ranges import range_of
from tribolab.arrays.reversals import reversals
from tribolab.core.errors import shown
from tribolab.core.wording import Count
from tribolab.reading.interpret.missing import missing_inputs
from tribolab.reading.lexicon.lexicon import normalise_label, part_pattern
from tribolab.reading.runs.file_facts import CompanionFacts, FileFacts
from tribolab.reading.runs.force_ratio import doubt_about, doubt_about_coefficient
from tribolab.reading.text.cells import split_name

if TYPE_CHECKING:
    import numpy as np
from tribolab.app.info.metadata_lines import metadata_lines

_OF_MOTION = {"sliding_velocity", "position", "rotation_speed", "step", "set_speed"}
_WAYS = {
    "classes": "classes of velocity",
    "starts": "the starts of motion",
    "motion": "a fit by distance, speed and acceleration",
}


def run_lines(facts: FileFacts) -> list[str]:
    """Return lines on how the raw file of a run is read: sampling, columns and metadata.

    Parameters
    ----------
    facts
        From `tribolab.reading.runs.file_facts.file_facts`.
    """
    title = f" ({facts['title']})" if facts["title"] else ""
    lines = [f"{facts['file']}: {facts['instrument'] or 'netCDF'}{title}"]
    sampling = f"  {Count(facts['rows']):row|rows} over {facts['duration_s']:.6g} s"
    if facts["are_points"]:
        sampling = (
            f"  {Count(facts['rows']):result|results}, each at one speed: its error is unknown"
        )
    elif facts["interval_s"] is not None:
        sampling += f", one every {facts['interval_s']:.3g} s"
        if facts["longest_interval_s"] is not None:
            sampling += f", at most {facts['longest_interval_s']:.3g} s"
    lines.append(sampling + (f", {Count(facts['steps']):step|steps}" if facts["steps"] else ""))
    if facts["left_out"]:
        lines.append(f"  left out: {facts['left_out']}")
    width = max((len(name) for name in facts["columns"]), default=0)
    for name, column in facts["columns"].items():
        span = range_of(f"{column['minimum']:.6g}", f"{column['maximum']:.6g}")
        span += f" {column['unit']}" if column["unit"] != "1" else ""
        label = f"   from '{shown(column['label'])}'" if column["label"] else ""
        lines.append(f"  {name:<{width}}  {span}{label}")
    if facts["not_used"]:
        lines.append(f"  not used: {', '.join(map(shown, facts['not_used']))}")
    lines += metadata_lines(facts["metadata"], facts["file"])
    return lines


def missing_lines(facts: FileFacts, columns: Mapping[str, np.ndarray]) -> list[str]:
    """Return lines on the inputs that are missing for a friction coefficient against speed.

    Parameters
    ----------
    facts
        From `tribolab.reading.runs.file_facts.file_facts`.
    columns
        Signals by quantity.
    """
    names = set(facts["columns"])
    forces = {"friction_force", "friction_coefficient", "shear_stress", "normal_force"}
    if not names & forces and names & _OF_MOTION:
        return []  # a log of motion only: the forces of the run are in another log
    if "set_speed_m_s" in facts["metadata"]:
        names.add("set_speed")
    if facts["not_used"] and not names & {"sliding_velocity", "position", "set_speed"}:
        # imported late for a quick start
        from tribolab.reading.interpret.names import is_stroke_frequency

        if any(is_stroke_frequency(*split_name(label)) for label in facts["not_used"]):
            names.add("frequency")
    turned = any(part_pattern("sine").search(normalise_label(x)) for x in facts["not_used"])
    rig = {"crank"} if "drive" in facts["metadata"] or turned else set()  # driven by a crank
    if "friction_force" in columns and reversals(columns["friction_force"]):
        rig.add("reversals")
    lacks = missing_inputs(names, rig)
    return [f"  missing: {f'{x.what}: {x.option}' if x.option else x}" for x in lacks]


def doubt_lines(signals: Mapping[str, np.ndarray]) -> list[str]:
    """Return a line on friction that is physically implausible; empty if it is plausible."""
    doubt = ""
    if "friction_coefficient" in signals and "friction_force" not in signals:
        doubt = doubt_about_coefficient(signals["friction_coefficient"])
    elif {"friction_force", "normal_force"} <= set(signals):
        doubt = doubt_about(signals["friction_force"], signals["normal_force"])
    return [f"  doubtful: {doubt}"] if doubt else []


def companion_lines(facts: CompanionFacts) -> list[str]:
    """Return lines on the second log of a run: whether it was found, and its clock shift.

    Parameters
    ----------
    facts
        From `tribolab.reading.runs.file_facts.describe_companion`.
    """
    if "missing" in facts:
        return [f"  companion log: {facts['missing']} does not exist"]
    if "ways" not in facts:
        return [f"  companion log: refused: {facts['refused']}"] if facts else []
    lines = [f"  companion log: found ({facts['instrument']})"]
    if "refused" in facts:
        lines.append(
            f"  clock shift: cannot be determined from the signals ({facts['refused']}); state "
            "clock_shift in [[run]] of a campaign file"
        )
    else:
        lines.append(
            f"  clock shift: {facts['shift_s']:.6g} s, standard uncertainty "
            f"{facts['uncertainty_s']:.2g} s, {facts['source']}"
        )
    return lines + [
        f"    from {_WAYS.get(name, name)}: {way}" for name, way in facts["ways"].items()
    ]
