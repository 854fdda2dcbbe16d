"""Web page and tables of a repeatability study."""

from __future__ import annotations

from pathlib import Path

from tribolab import plot
from tribolab.comparison.page import Part, Picture, Sheet, cells, write_parts
from tribolab.comparison.repeat_study import FEW, Repeatability, repeatability_verdict
from tribolab.core.wording import many, percent
from tribolab.report import tables


def write_repeatability(study: Repeatability, heading: str, folder: Path) -> Path:
    """Write ``repeatability.html`` and its tables, and return the page."""
    folder.mkdir(parents=True, exist_ok=True)
    tables.write_csv(study.table, folder / "repeatability.csv")
    if not study.mandel.empty:
        tables.write_csv(study.mandel, folder / "mandel.csv")
    drawn = Picture(
        plot.precision(study.table, title=", ".join(study.by)),
        "Standard deviations within runs that were measured alike, between the levels of each "
        "factor, and all together, relative to the mean.",
        "Standard deviations over sliding speed.",
    )
    part = Part(
        "components",
        "Components of variance",
        texts=_explanations(study),
        figures=(drawn,),
        tables=(_components(study),),
        notes=(
            f"Told apart by {study.method}. The unit is the run. r and R are 2.8 standard "
            "deviations (ISO 5725-2). The last row is relative to the mean.",
        ),
    )
    page = folder / "repeatability.html"
    odd = [] if study.mandel.empty else [_mandel(study)]
    write_parts(
        page,
        kind="Repeatability",
        heading=heading,
        verdict=repeatability_verdict(study),
        fine=True,
        parts=(part, *odd),
    )
    return page


def _explanations(study: Repeatability) -> tuple[str, ...]:
    """Return a text that explains the limits r and R, and names factors with too few levels."""
    last = study.table.iloc[-1]
    texts = [
        f"Of two runs that were measured alike, 95 of 100 pairs differ by less than "
        f"{percent(float(last['repeatability_limit']))} of the mean (r); where "
        f"{' and '.join(study.by)} change between them, by less than "
        f"{percent(float(last['reproducibility_limit']))} (R)."
    ]
    few = [
        f"{many(count, 'level')} of {name}" for name, count in study.levels.items() if count < FEW
    ]
    if few:
        texts.append(
            f"There were only {' and '.join(few)}: what lies between levels, and R with it, is a "
            "rough guess; five or more tell."
        )
    return tuple(texts)


def _components(study: Repeatability) -> Sheet:
    names = [c for c in map(str, study.table) if c not in ("sliding_speed_m_s", "speed")]
    heads = {
        "mean": "Mean",
        "repeatability_std": "Within",
        "reproducibility_std": "All together",
        "repeatability_limit": "r",
        "reproducibility_limit": "R",
        "runs": "Runs",
        "degrees_of_freedom": "Degrees of freedom",
    }
    titles = [
        heads.get(name, name.removesuffix("_std").replace("_", " ").capitalize()) for name in names
    ]
    rows = [
        cells((row["speed"], *(row[name] for name in names)))
        for row in study.table.to_dict("records")
    ]
    return Sheet("Components of variance", "repeatability", ("Speed", *titles), rows)


def _mandel(study: Repeatability) -> Part:
    name = study.by[0]
    rows = [
        cells((row["condition"], row["sliding_speed_m_s"] * 1e6, str(row[name]),
               row["h"], row["h_limit"], row["k"], row["k_limit"]))
        for row in study.mandel.to_dict("records")
    ]  # fmt: skip
    heads = ("Condition", "Speed (µm/s)", name.capitalize(), "h", "limit", "k", "limit")
    return Part(
        "mandel",
        f"Which {name} is odd",
        texts=(
            "Mandel's h says how far a mean is off, k how much larger its scatter is than usual; "
            "both are beyond their limit by chance in one of a hundred.",
        ),
        tables=(Sheet("Mandel's h and k", "mandel", heads, rows),),
    )
