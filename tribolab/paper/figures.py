"""List of the figures of the reproduction, with section, sources and caption."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

from tribolab.core.untyped import Json
from tribolab.paper import drawing
from tribolab.paper.data import PaperData
from tribolab.paper.drawing import FigureAndText
from tribolab.records.part_records import FigureRecord
from tribolab.report.figures.stage import DRAWING, write_figure

COMPUTED, SIMULATED = "computed here", "simulated"
_STAND_IN = (
    "The spectra are stand-ins with the paper's roughness and slope; those that the authors "
    "measured are published as a picture."
)
_POINTS = (
    "Points: simulated by the virtual rig and analysed like measured ones; bars: "
    "standard deviation while sliding, as in the paper, mostly smaller than the markers "
    "(Appendix C shows them)."
)
_BARS = (
    "Points: simulated by the virtual rig. (a) Bars: standard deviation while sliding, within one "
    "run at each load; lines guide the eye. (b) The bars themselves: standard deviation (filled) "
    "and U95 of the mean (open, 95 % coverage) within one run; repeatability is not included."
)
_RIG = "What the authors measured is published as a picture without numbers."
_TRACES = (
    "Traces of the virtual rig, shifted up or down by the amount next to each for clarity; those "
    "without an amount are not shifted."
)
_SLIP = (
    f"{_TRACES} That Smooth sticks and slips is the authors' observation, how far and how often is "
    "an assumption of the rig."
)


@dataclass(frozen=True)
class PlannedFigure:
    """A figure of the reproduction and how it is made.

    Parameters
    ----------
    name
        Name of its file.
    section
        Key of its section of the paper.
    title
        Title.
    kinds
        Origin of its data: `COMPUTED`, `SIMULATED` or both.
    caption
        Full sentences below it.
    draw
        Function that draws it.
    claims
        Published numbers that belong to it: quantity, surface ("" for any), a part of the
        condition.
    wide
        Whether it needs the full width of the page.
    has_text
        Whether its numbers are repeated in the caption.
    """

    name: str
    section: str
    title: str
    kinds: tuple[str, ...]
    caption: str
    draw: Callable[[PaperData], FigureAndText]
    claims: tuple[tuple[str, str, str], ...] = ()
    wide: bool = False
    has_text: bool = False

    @property
    def file(self) -> str:
        """Path of the figure relative to the results folder."""
        return f"figures/{self.name}.svg"

    def has(self, row: Mapping[str, Any]) -> bool:
        """Return whether a published number belongs to this figure."""
        return any(
            row["quantity"] == quantity
            and surface in ("", row["surface"])
            and condition in row["condition"]
            for quantity, surface, condition in self.claims
        )


FIGURES = (
    PlannedFigure(
        "spectra", "topography", "Surface roughness power spectra", (COMPUTED,),
        "Roughness and slope are the paper's by construction. " + _STAND_IN,
        drawing.paper_spectra, (("rms_roughness", "", ""), ("rms_slope", "", "")),
    ),
    PlannedFigure(
        "spectra_from_profiles", "topography", "Spectra from simulated profiles", (SIMULATED,),
        "What the analysis makes of profiles that the virtual profilometer took of the stand-in "
        "surfaces: full where measured, dashed where extrapolated, shaded the 95 % band.",
        drawing.scanned_spectra,
    ),
    PlannedFigure(
        "contact_area", "topography", "Contact area without adhesion", (COMPUTED,),
        "Grey: mean Hertz pressures of the four loads. " + _STAND_IN,
        drawing.paper_contact_area, (("contact_area_ratio", "", "0.042 MPa; no adhesion"),),
    ),
    PlannedFigure(
        "effective_work", "adhesion", "Effective work of adhesion over magnification", (COMPUTED,),
        "As the pressure vanishes, over the work γ₀ of smooth surfaces: 64 mJ/m² dry (dashed) and "
        "51 mJ/m² in glycerol (full). Zero at magnification 1 means no pull-off force; that only "
        "Smooth has one the authors found by hand. At the highest magnification it exceeds 1, as "
        "a rough surface has more area than its projection.",
        drawing.paper_effective_work,
        (("work_of_adhesion", "", ""), ("macroscopic_work_of_adhesion", "", "")),
    ),
    PlannedFigure(
        "adhesive_area", "adhesion", "Contact area with adhesion", (COMPUTED,),
        "Dotted: without adhesion; dashed: dry; full: in glycerol. Grey: mean Hertz pressures. The "
        "paper's text and caption swap full and dotted lines.",
        drawing.paper_adhesive_area,
        (
            ("contact_area_ratio", "", "0.042 MPa; adhesion"),
            ("dry_over_glycerol_area", "", ""),
        ),
    ),
    PlannedFigure(
        "dry_friction", "dry", "Dry friction over speed", (SIMULATED,),
        _POINTS + " The rig's dry friction has the paper's ratio of shear stresses; its level is "
        "an assumption. " + _RIG,
        drawing.dry_friction,
    ),
    PlannedFigure(
        "modulus", "dry", "Viscoelastic modulus of the rubber", (COMPUTED,),
        "A stand-in (1.5 MPa at rest, 1 GPa as a glass): the authors' measured modulus is a "
        "picture without numbers.",
        drawing.paper_modulus,
    ),
    PlannedFigure(
        "viscoelastic", "dry", "Viscoelastic contribution to friction", (COMPUTED,),
        "At 0.0417 MPa, without adhesion; dashed: Smooth in complete contact. With the stand-in "
        "modulus, so an order of magnitude only.",
        drawing.paper_viscoelastic,
        (("viscoelastic_friction", "", ""), ("area_enhancement", "", "dry")),
    ),
    PlannedFigure(
        "dry_shear_stress", "dry", "Dry shear stress over speed", (SIMULATED, COMPUTED),
        "Simulated friction times nominal pressure over the computed dry contact area with "
        "adhesion; bars: standard deviation while sliding. The ratio is what the rig was given, "
        "except for the areas, which are computed:",
        drawing.dry_shear_stress, (("effective_shear_stress_ratio", "", ""),), has_text=True,
    ),
    PlannedFigure(
        "dry_traces", "dry", "Dry friction over sliding distance", (SIMULATED,), _SLIP,
        drawing.dry_traces, wide=True,
    ),
    PlannedFigure(
        "stribeck_both", "stribeck", "Sb-S and Sb-R at 310 N/m", (COMPUTED, SIMULATED),
        "Lines: mixed-lubrication theory with the printed shear stress. " + _POINTS + " Open: dry. "
        "The rig was given that same theory, so agreement tests the analysis and not the theory. "
        + _RIG,
        drawing.both_rough,
    ),
    PlannedFigure(
        "stribeck_sb-s", "stribeck", "Sb-S at all loads", (COMPUTED, SIMULATED),
        "Lines: theory with the printed shear stress of each load. " + _POINTS,
        partial(drawing.all_loads, name="Sb-S"), (("shear_stress", "Sb-S", ""),),
    ),
    PlannedFigure(
        "stribeck_sb-r", "stribeck", "Sb-R at all loads", (COMPUTED, SIMULATED),
        "Lines: theory with the printed shear stress of each load. " + _POINTS,
        partial(drawing.all_loads, name="Sb-R"), (("shear_stress", "Sb-R", ""),),
    ),
    PlannedFigure(
        "shear_stress", "stribeck", "Shear stress over load", (COMPUTED, SIMULATED),
        "Open: fitted to the simulated points, for the area without adhesion; filled: divided by "
        "the computed growth of the area by adhesion in glycerol. Bars: 95 %. The authors' own "
        "fits, which the rig was given, are in the table.",
        drawing.paper_shear_stress,
        (
            ("contact_area_ratio", "", "0.1 MPa"),
            ("area_enhancement", "Sb-S", "at the loads"),
            ("area_enhancement", "Sb-R", "at the loads"),
            ("corrected_shear_stress_ratio", "", ""),
        ),
    ),
    PlannedFigure(
        "smooth_and_theory", "stribeck", "Smooth against theory", (COMPUTED, SIMULATED),
        "Line: theory at 310 N/m with the printed 0.5 MPa. Points: the virtual rig, which follows "
        "what the authors report and their theory does not give: a plateau up to about 10 µm/s.",
        drawing.smooth_and_theory,
        (
            ("shear_stress", "Smooth", ""),
            ("area_enhancement", "Smooth", ""),
            ("corrected_shear_stress", "", ""),
            ("boundary_onset_speed", "", ""),
        ),
    ),
    PlannedFigure(
        "wet_traces", "stribeck", "Friction in glycerol over sliding distance", (SIMULATED,),
        _SLIP, drawing.wet_traces, wide=True,
    ),
    PlannedFigure(
        "sb-r_dry_and_wet", "discussion", "Sb-R, dry and in glycerol", (SIMULATED,),
        f"{_TRACES} Nothing oscillates: what is seen is the rig's noise.",
        drawing.rough_dry_and_wet, wide=True,
    ),
    PlannedFigure(
        "smooth_dry_and_wet", "discussion", "Smooth, dry and in glycerol; Sb-R in glycerol",
        (SIMULATED,), _SLIP, drawing.smooth_dry_and_wet, wide=True,
    ),
    PlannedFigure(
        "contact_separation", "factors", "Contact pressure over separation", (COMPUTED,),
        "Persson's theory without adhesion. " + _STAND_IN,
        drawing.separation, (("separation_decay_alpha", "", ""),),
    ),
    PlannedFigure(
        "factors", "factors", "Flow factors and friction factors", (COMPUTED,),
        "(a) Pressure and shear flow factor, the rough body at rest: over separation in units of "
        "the roughness, the three surfaces nearly share one line. (b) Friction factors.",
        drawing.factors, (("percolation_separation", "", ""),), wide=True,
    ),
    PlannedFigure(
        "friction_factor_effect", "factors", "With and without friction factors", (COMPUTED,),
        "At the highest load with the printed shear stress. Full: with them; dashed: without. The "
        "paper draws Sb-R alone, with a small effect, and finds none to be seen on Sb-S. Here:",
        drawing.paper_friction_factor_effect, has_text=True,
    ),
    PlannedFigure(
        "profiles_sb-s", "profiles", "Across the contact of Sb-S at 310 N/m", (COMPUTED,),
        "The flat slides to the right: (a) mean separation, (b) pressure in the solid contact, (c) "
        "pressure in the fluid. The paper does not print its speeds; these are ours.",
        partial(drawing.profiles, name="Sb-S"),
        (
            ("contact_max_pressure", "Sb-S", ""),
            ("contact_width", "Sb-S", ""),
        ),
        wide=True,
    ),
    PlannedFigure(
        "profiles_sb-r", "profiles", "Across the contact of Sb-R at 310 N/m", (COMPUTED,),
        "As above, for Sb-R.",
        partial(drawing.profiles, name="Sb-R"),
        (
            ("contact_max_pressure", "Sb-R", ""),
            ("contact_width", "Sb-R", ""),
        ),
        wide=True,
    ),
    *(
        PlannedFigure(
            f"error_bars_{name.lower()}", "bars", f"{name} with error bars", (SIMULATED,),
            _BARS, partial(drawing.bars, name=name),
        )
        for name in ("Sb-S", "Sb-R", "Smooth")
    ),
)  # fmt: skip
BY_NAME = {figure.name: figure for figure in FIGURES}


@dataclass(frozen=True)
class DrawTask:
    """Figure to draw, with the data that it needs."""

    name: str
    data: PaperData


def draw_paper_figure(task: DrawTask) -> Json:
    """Draw a figure into the results folder, and return its record."""
    known = BY_NAME[task.name]
    with DRAWING:
        figure, text = known.draw(task.data)
        alt = f"{known.title} ({' and '.join(known.kinds)}). {text}"
        caption = f"{known.caption} {text}" if known.has_text else known.caption
        data = write_figure(figure, task.data.folder, known.file)
        record = asdict(FigureRecord(known.file, data, caption, alt))
    del record["kind"]  # the section already says what kind of figure it is
    return record | {
        "name": known.name,
        "section": known.section,
        "title": known.title,
        "kinds": list(known.kinds),
        "wide": known.wide,
    }
