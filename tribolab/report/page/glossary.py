"""Glossary of the page, shown at table heads and as a list."""

from __future__ import annotations

GLOSSARY: dict[str, str] = {
    "µ": "Friction coefficient: friction force divided by normal force, both at the same moment, "
    "averaged over a stroke.",
    "± U95": "Expanded uncertainty with 95 % coverage. Every ± of a friction coefficient is a U95. "
    "It includes the scatter of the data, the repeats if there are any, and the calibration "
    "uncertainty if it was given. Without a calibration it is statistical only.",
    "within the run": "U95 from the scatter within one run; correlated samples count less, and "
    "the two strokes of a half loop count once. Repeatability is not included.",
    "between runs": "U95 from the scatter of repeated runs of the same surface, medium and load. "
    "Few runs widen it (Student's t).",
    "Standard error": "Standard error of the mean (coverage 68 %), for the tables and the fits.",
    "Degrees of freedom": "Effective degrees of freedom (Welch and Satterthwaite). Few degrees of "
    "freedom widen U95 (Student's t).",
    "Plateau": "Range of slow speeds in which friction stays within a tenth of its highest value "
    "and differs from it by no more than their errors allow: the solids touch and the liquid "
    "carries nothing.",
    "Lift-off": "The liquid between the surfaces carries more and more of the load as they move "
    "faster, and friction falls. Told by the speed at which half of the highest friction is left.",
    "Segment": "A stretch of a run at constant speed in one direction: one stroke.",
    "Independent samples": "How many samples a record is worth once those that repeat their "
    "neighbours are not counted twice (n_eff).",
    "Noise": "Standard deviation of friction along a segment divided by its mean; the median over "
    "the segments of a run.",
    "Drift": "Largest significant change of friction along a segment, divided by the mean friction "
    "of the run.",
    "Left out": "Time of the record that no number uses: at rest, while the speed changes, or too "
    "short.",
    "Half loop": "Half the difference of the forces of a stroke forward and a stroke back: the "
    "friction force without the offset of the sensor.",
    "Shear stress σ": "Friction force divided by the real contact area, fitted to the measured "
    "curve; one number for all speeds.",
    "95 % interval": "Range that holds the true value in 95 of 100 such campaigns, if the model is "
    "right.",
    "χ² per freedom": "Mean square of measured less computed friction in units of the error bars; "
    "about 1 if the model describes the curve within them.",
    "Runs test p": "Probability that residuals of a right model have as long rows of one sign as "
    "these. Below 0.05: the shape of the curve differs.",
    "A/A₀": "Real contact area over the nominal one.",
    "Pull-off force": "Force needed to pull the bodies apart: there is one if adhesion reaches the "
    "macroscopic scale.",
    "h rms": "Root mean square of the heights by the spectrum, extrapolated: what theory takes.",
    "Rq": "Root mean square of the heights, without form and waves beyond the cut-off (ISO).",
    "Pq": "Root mean square of all heights of the scan without form, no cut-off applied (ISO).",
    "Sq": "Root mean square of all heights of a map without form, no cut-off applied (ISO 25178).",
    "Slope rms": "Root mean square of the slopes of the roughness.",
    "Hurst exponent": "How roughness grows with the length it is looked at: slope of the power "
    "spectrum is −2(1 + H). Fractal from 0 to 1; above 1 the surface is smooth at short distances.",
    "Roll-off": "Wavenumber below which the power spectrum no longer rises.",
    "Stick-slip": "Friction rises and falls at constant speed: sticking and slipping by turns.",
    "Macroscopic instability, controlled by adhesion": "The rubber surface as a whole buckles and "
    "detaches in folds that run across the contact, because adhesion holds it back; roughness does "
    "not undo it. Friction then swings although no spring of the rig takes part.",
    "Forced wetting": "Speed above which the motion drags liquid between the surfaces faster than "
    "it is squeezed out: adhesion no longer closes the contact.",
    "Sliding mode": "Whether a contact slides steadily, slips because of the rig's spring, or "
    "because adhesion folds the surface.",
    "Rejected": "A run whose checks failed, or that a person rejected (by hand): its numbers are "
    "shown, struck through, and no curve uses them.",
    "Failed": "A run that could not be read or computed: there are no numbers of it.",
    "Suspect": "A check found something that may spoil the numbers; they are used.",
}

# terms for campaigns of surfaces only
OF_SURFACES = frozenset(
    ("A/A₀", "Pull-off force", "h rms", "Rq", "Pq", "Sq", "Slope rms", "Hurst exponent", "Roll-off")
)

# of these, terms that require a contact
OF_CONTACT = frozenset(("A/A₀", "Pull-off force"))

# terms that require a rubber or a fitted model
OF_MODELS = frozenset(
    (
        *("Shear stress σ", "95 % interval", "χ² per freedom", "Runs test p", "Forced wetting"),
        "Macroscopic instability, controlled by adhesion",
    )
)


def words_of(*, runs: bool, surfaces: bool, contact: bool, models: bool) -> dict[str, str]:
    """Return the terms used on a page with these sections, with their meanings.

    >>> sorted(words_of(runs=False, surfaces=True, contact=False, models=False))[:3]
    ['Hurst exponent', 'Pq', 'Roll-off']
    """
    left = set() if models else OF_MODELS
    left = left if contact else left | OF_CONTACT
    left = left if surfaces else left | OF_SURFACES
    return {
        word: meaning
        for word, meaning in GLOSSARY.items()
        if word not in left and (runs or word in OF_SURFACES)
    }


# terms explained at their first use on the first screen
TERMS: dict[str, str] = {
    "lift off": GLOSSARY["Lift-off"],
    "plateau": GLOSSARY["Plateau"],
    "adhesion-controlled macroscopic instability": GLOSSARY[
        "Macroscopic instability, controlled by adhesion"
    ],
    "stick-slip": GLOSSARY["Stick-slip"],
    "forced wetting": GLOSSARY["Forced wetting"],
    "mixed lubrication": "Part of the load is carried by touching solids and part by the liquid "
    "between them: what the model computes, without any instability.",
    "shear stress": GLOSSARY["Shear stress σ"],
    "segments": GLOSSARY["Segment"],
    "between runs": GLOSSARY["between runs"],
    "within the run": GLOSSARY["within the run"],
}

# column heads explained by a glossary entry or by their own text
HEADS: dict[str, str] = {
    "Run": "Name of the run, from its raw file. Below it the gravest objection of its checks.",
    "State": "ok; suspect: a check doubts it; odd: it contradicts its repeats; rejected: its "
    "checks failed, or a person rejected it, and no curve includes it; failed: not read.",
    "Dev.": "Deviation from the median of the usable repeats at the chosen speed.",
    "Running-in distance": "Distance after which friction is steady.",
    "Steady µ": "Mean friction coefficient ± U95 (within the run) of the steady part.",
    "Speed at half µ max": "Speed at which µ drops to half its maximum.",
    "Noise": GLOSSARY["Noise"],
    "Drift": GLOSSARY["Drift"],
    "Left out": GLOSSARY["Left out"],
    "Segments": GLOSSARY["Segment"],
    "Stick-slip": GLOSSARY["Stick-slip"],
    "Load": "Normal force that was set; measured where none was stated.",
    "Medium": "What is between the surfaces.",
    "A/A₀": GLOSSARY["A/A₀"],
    "Hurst exponent": GLOSSARY["Hurst exponent"],
    "Rq (µm)": GLOSSARY["Rq"] + " Small: the cut-off.",
    "Pq (µm)": GLOSSARY["Pq"],
    "Sq (µm)": GLOSSARY["Sq"] + " Small: Sa.",
    "h rms (µm)": GLOSSARY["h rms"] + " Small: outer bounds of the extrapolated spectrum.",
    "Slope rms": GLOSSARY["Slope rms"],
    "Measured rms slope": "Rms slope of all waves that the scans resolve. Shorter waves add to it: "
    "see the surface's details.",
    "Roll-off (1/mm)": GLOSSARY["Roll-off"],
    "σ (MPa)": GLOSSARY["Shear stress σ"],
    "95 % interval (MPa)": GLOSSARY["95 % interval"],
    "Part of the spectrum": "How far the fitted shear stress moves when the roughness spectrum "
    "goes to the ends of its band.",
    "Verdict": "Whether the model describes the curve, from χ² per freedom and the order of the "
    "residuals.",
    "χ² per freedom": GLOSSARY["χ² per freedom"],
    "Runs test p": GLOSSARY["Runs test p"],
    "Describes": "Widest range of speeds that one shear stress describes within the errors.",
    "Pull-off force": GLOSSARY["Pull-off force"],
    "Effective samples": GLOSSARY["Independent samples"],
    "Independent samples": GLOSSARY["Independent samples"],
    "Standard error": GLOSSARY["Standard error"],
    "Standard deviation": "How far friction varies about its mean while sliding.",
    "Trend": "Change of friction along the segment, and whether chance alone explains it.",
    "± U95": GLOSSARY["± U95"],
    "Includes": "Between runs: " + GLOSSARY["between runs"] + " Within the run: the scatter within "
    "the only run.",
    "Macroscopic (mJ/m²)": "Effective work of adhesion seen without a magnifier, as the load "
    "vanishes; above zero there is a pull-off force.",
    "Work of adhesion (mJ/m²)": "Energy per area to part two smooth surfaces of these materials.",
    "Enhancement": "Contact area with adhesion over that without.",
    "Mean gap (µm)": "Mean distance between the surfaces' mean planes.",
    "µ viscoelastic, 1 mm/s": "Friction by losses in the rubber alone, without adhesion.",
}
