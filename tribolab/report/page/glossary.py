"""Terms of the page with their meanings, for table heads and for the list of terms."""

from __future__ import annotations

GLOSSARY: dict[str, str] = {
    "µ": "Friction coefficient: friction force divided by normal force, both at the same moment, "
    "averaged over a stroke.",
    "± U95": "Expanded uncertainty with 95 % coverage. Every ± of a friction coefficient is a "
    "U95. It includes the scatter of the data, the repeats if there are any, and the calibration "
    "uncertainty if it was given. Without a calibration it is statistical only.",
    "within the run": "U95 from the scatter within one run; correlated samples count less, and "
    "the two strokes of a half loop count as one observation. Repeatability is not included.",
    "between runs": "U95 from the scatter of repeated runs of the same surface, medium and load. "
    "Few runs widen it (Student's t).",
    "Standard error": "Standard error of the mean (coverage 68 %), for the tables and the fits.",
    "Degrees of freedom": "Effective degrees of freedom (Welch and Satterthwaite). Few degrees of "
    "freedom widen U95 (Student's t).",
    "Plateau": "Range of low speeds in which friction is within 10 % of its maximum, and within "
    "the errors: the solid contact carries the load.",
    "Lift-off": "With increasing speed the liquid carries more of the load, and friction falls. "
    "It is characterised by the speed at which µ drops to half its maximum.",
    "Segment": "Interval of a run at constant speed in one direction, e.g. one stroke.",
    "Independent samples": "Effective number of independent samples (n_eff); neighbouring samples "
    "are correlated.",
    "Noise": "Standard deviation of friction along a segment divided by its mean; the median over "
    "the segments of a run.",
    "Drift": "Largest significant change of friction along a segment, divided by the mean "
    "friction of the run.",
    "Left out": "Time of the record that is excluded from all results: rest, changing speed, or "
    "segments that are too short.",
    "Half loop": "Half the difference between the forces of a forward and a return stroke: the "
    "friction force without the offset of the sensor.",
    "Shear stress σ": "Friction force divided by the real contact area, fitted to the measured "
    "curve; one number for all speeds.",
    "95 % interval": "Range that contains the true value in 95 of 100 such campaigns, if the "
    "model is right.",
    "χ² per degree of freedom": "Mean square of the residuals divided by their standard errors; "
    "about 1 if the model fits within the errors.",
    "Runs test p": "Probability that a correct model gives residuals with as few sign changes. "
    "Below 0.05: the shape of the curve differs.",
    "A/A₀": "Real contact area divided by nominal contact area.",
    "Pull-off force": "Force needed to pull the bodies apart; zero unless adhesion reaches the "
    "macroscopic scale.",
    "h rms": "Rms height from the extrapolated spectrum, as used by the theory.",
    "Rq": "Rms height after removal of form and of waves longer than the cut-off (ISO).",
    "Pq": "Rms height of the scan after removal of form, without cut-off (ISO).",
    "Sq": "Rms height of a map after removal of form, without cut-off (ISO 25178).",
    "Slope rms": "Rms slope of the roughness.",
    "Hurst exponent": "Sets the slope of the power spectrum, −2(1 + H). From 0 to 1 the surface "
    "is self-affine; above 1 it is smooth at short wavelengths.",
    "Roll-off": "Wavenumber below which the power spectrum is flat.",
    "Stick-slip": "Friction oscillates at constant drive speed because the surfaces alternately "
    "stick and slip.",
    "Macroscopic instability, controlled by adhesion": "Adhesion holds the rubber surface back "
    "until it buckles, and detachment folds travel through the whole contact. Friction then "
    "oscillates even with a rigid drive.",
    "Forced wetting": "Above this speed, liquid is entrained faster than it is squeezed out, so "
    "adhesion no longer closes the contact.",
    "Sliding mode": "Steady sliding, stick-slip caused by the stiffness of the rig, or folds of "
    "the surface caused by adhesion.",
    "Rejected": "A run that failed a check, or that a person rejected (by hand). Its numbers are "
    "struck through and excluded from the curves.",
    "Failed": "A run that could not be read or analysed, so it has no results.",
    "Suspect": "A check found a possible error. The results are still used.",
}

# terms that only pages with surfaces need
OF_SURFACES = frozenset(
    ("A/A₀", "Pull-off force", "h rms", "Rq", "Pq", "Sq", "Slope rms", "Hurst exponent", "Roll-off")
)

# terms of OF_SURFACES that only pages with a contact need
OF_CONTACT = frozenset(("A/A₀", "Pull-off force"))

# terms that only pages with a model need
OF_MODELS = frozenset(
    (
        *("Shear stress σ", "95 % interval", "χ² per degree of freedom", "Runs test p"),
        *("Forced wetting", "Macroscopic instability, controlled by adhesion"),
    )
)


def words_of(*, runs: bool, surfaces: bool, contact: bool, models: bool) -> dict[str, str]:
    """Return the terms with their meanings for the parts that a page has.

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


# terms with a tooltip at their first use on the first screen
TERMS: dict[str, str] = {
    "lift off": GLOSSARY["Lift-off"],
    "plateau": GLOSSARY["Plateau"],
    "adhesion-controlled macroscopic instability": GLOSSARY[
        "Macroscopic instability, controlled by adhesion"
    ],
    "stick-slip": GLOSSARY["Stick-slip"],
    "forced wetting": GLOSSARY["Forced wetting"],
    "mixed lubrication": "The solid contact carries part of the load and the liquid the rest. The "
    "model assumes this, without any instability.",
    "shear stress": GLOSSARY["Shear stress σ"],
    "segments": GLOSSARY["Segment"],
    "between runs": GLOSSARY["between runs"],
    "within the run": GLOSSARY["within the run"],
}

# column heads explained by a glossary entry or by their own text
HEADS: dict[str, str] = {
    "Run": "Name of the run, from its raw file, and its most serious finding.",
    "State": "ok; suspect: a check found a possible error; odd: contradicts its repeats; rejected "
    "(by a check or a person): excluded from the curves; failed: could not be read or analysed.",
    "Dev.": "Deviation from the median of the usable repeats at the chosen speed.",
    "Running-in distance": "Distance after which friction is steady.",
    "Steady µ ± U95": "Mean friction coefficient of the steady part; U95 within the run, or "
    "between repeats.",
    "Speed at half of highest µ": "Speed at which µ drops to half its highest value.",
    "Fitted shear stress (MPa)": "Shear stress of the fitted model, with its 95 % interval.",
    "Noise": GLOSSARY["Noise"],
    "Drift": GLOSSARY["Drift"],
    "Left out": GLOSSARY["Left out"],
    "Segments": GLOSSARY["Segment"],
    "Stick-slip": GLOSSARY["Stick-slip"],
    "Load": "Nominal normal force; the measured one if none is stated.",
    "Medium": "What is between the surfaces.",
    "A/A₀": GLOSSARY["A/A₀"],
    "Hurst exponent": GLOSSARY["Hurst exponent"],
    "Rq (µm)": GLOSSARY["Rq"] + " Small print: the cut-off.",
    "Pq (µm)": GLOSSARY["Pq"],
    "Sq (µm)": GLOSSARY["Sq"] + " Small print: Sa.",
    "h rms (µm)": GLOSSARY["h rms"] + " Small print: bounds from the extrapolated spectrum.",
    "Slope rms": GLOSSARY["Slope rms"],
    "Measured rms slope": "Rms slope of all wavelengths that the scans resolve. Shorter ones "
    "increase it: see the section on surfaces.",
    "Roll-off (1/mm)": GLOSSARY["Roll-off"],
    "σ (MPa)": GLOSSARY["Shear stress σ"],
    "95 % interval (MPa)": GLOSSARY["95 % interval"],
    "Part of the spectrum": "Change of the fitted shear stress if the roughness spectrum is at "
    "the lower or upper end of its band.",
    "Verdict": "Whether the model fits the curve, from χ² per degree of freedom and the signs of "
    "the residuals.",
    "χ² per degree of freedom": GLOSSARY["χ² per degree of freedom"],
    "Runs test p": GLOSSARY["Runs test p"],
    "Describes": "Widest range of speeds that one shear stress describes within the errors.",
    "Pull-off force": GLOSSARY["Pull-off force"],
    "Effective samples": GLOSSARY["Independent samples"],
    "Independent samples": GLOSSARY["Independent samples"],
    "Standard error": GLOSSARY["Standard error"],
    "Standard deviation": "How far friction varies about its mean while sliding.",
    "Trend": "Change of friction along the segment, and whether it is significant.",
    "± U95": GLOSSARY["± U95"],
    "Includes": "Between runs: " + GLOSSARY["between runs"] + " Within the run: the scatter within "
    "the only run.",
    "Macroscopic (mJ/m²)": "Effective work of adhesion at magnification 1 and vanishing load; if "
    "above zero, there is a pull-off force.",
    "Work of adhesion (mJ/m²)": "Energy per area to separate two smooth surfaces of these "
    "materials.",
    "Enhancement": "Contact area with adhesion divided by that without.",
    "Mean gap (µm)": "Mean distance between the surfaces' mean planes.",
    "µ viscoelastic, 1 mm/s": "Friction from viscoelastic losses in the rubber only, without "
    "adhesion.",
}
