"""Commands that compare results."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tribolab.app.reported import Debug, leaving, reported
from tribolab.app.streams import say
from tribolab.core.errors import ConfigError


def compare(
    folders: Annotated[
        list[Path], typer.Argument(help="Results folders; each is compared with the first.")
    ],
    by: Annotated[
        str,
        typer.Option(
            help="Compare by surface or medium: the first two in one folder, or those of --level. "
            "With several folders: the intended difference between them."
        ),
    ] = "",
    level: Annotated[
        list[str] | None,
        typer.Option(
            help="The two surfaces or media to compare with --by; use it twice.", show_default=False
        ),
    ] = None,
    margin: Annotated[
        str, typer.Option(help='Largest difference that is unimportant, e.g. "5 %" or "0.01".')
    ] = "",
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Output folder for the page and its tables.")
    ] = Path("comparison"),
    debug: Debug = False,
) -> None:
    """Compare campaigns, or surfaces and media within one, with statistical significance.

    Lists changes in settings, code and data, differences of every curve at every speed with a joint
    error rate of 5 %, and differences of shear stresses and roughness.

        tribolab compare march/results june/results

        tribolab compare results --by surface --margin "5 %"
    """
    with reported(debug):
        # imported late for a quick start
        from tribolab.comparison.compare_page import comparison_verdict, write_comparisons
        from tribolab.comparison.comparison import compare as compared_with

        if len(folders) == 1 and not by:
            raise ConfigError("there is only one folder: name a second one, or use --by")
        others: list[Path | None] = [*folders[1:]] or [None]
        made = [
            compared_with(
                folders[0],
                other,
                by=by,
                levels=tuple(level or ()),
                margin=margin,
                pairs=len(others),
            )
            for other in others
        ]
        page = write_comparisons(made, output)
        for pair in made:
            for change in pair.changes:
                say(f"{change.kind}: {change.what}: {change.first} → {change.second}")
            say(comparison_verdict(pair))
        say(f"page: {page}")


def repeatability(
    campaign: Annotated[
        Path, typer.Argument(help="The campaign file, its folder, or a results folder.")
    ],
    by: Annotated[
        str,
        typer.Option(
            help="Factors that may affect the runs, separated by commas: mount, day, operator, "
            "specimen or other labels of the campaign file; day:mount if each day has new "
            "mounts."
        ),
    ] = "mount",
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Output folder for the page and its tables.")
    ] = Path("lab"),
    debug: Debug = False,
) -> None:
    """Estimate repeatability within a mount, and between mounts, days and operators.

    Reports components of variance at each speed and pooled, with the limits r and R of ISO 5725.
    The runs in the campaign file state operator, date and mount.

        tribolab lab repeatability campaign.toml --by mount,day,operator
    """
    with reported(debug, audience="campaign"):
        # imported late for a quick start
        from tribolab.comparison.repeat_study import repeatability as repeated
        from tribolab.comparison.repeat_study import repeatability_verdict
        from tribolab.comparison.repeatability_page import write_repeatability

        study = repeated(campaign, by)
        name = campaign.resolve().parent.name if campaign.is_file() else campaign.resolve().name
        page = write_repeatability(study, f"Repeatability of {name}", output)
        say(repeatability_verdict(study))
        say(f"page: {page}")


def history(
    folders: Annotated[
        list[Path],
        typer.Argument(help="Results folders, or folders that contain them, in any order."),
    ],
    rule: Annotated[list[str] | None, leaving("--rule", "choose rules in a notebook")] = None,
    baseline: Annotated[int | None, leaving("--baseline", "choose it in a notebook")] = None,
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Output folder for the page and its table.")
    ] = Path("lab"),
    debug: Debug = False,
) -> None:
    """Draw control charts of instruments over months: zeros, noise, tilt, set-points, reference.

    The exit code is 1 if a point signals. In the campaign files, `[reference]` names runs on a
    reference sample, and `[calibration]` states the date of calibration.

        tribolab lab history campaigns/*/results
    """
    with reported(debug):
        # imported late for a quick start
        from tribolab.comparison.history_page import history_verdict, write_history
        from tribolab.comparison.instrument_history import history as followed
        from tribolab.comparison.watched import results_below
        from tribolab.metrology.control_charts import DEFAULT_RULES

        history = followed(
            results_below(folders), rules=tuple(rule or DEFAULT_RULES), baseline=baseline
        )
        page = write_history(history, output)
        for name, due in history.due.items():
            date = due.date.isoformat() if due.date else "unknown"
            say(f"{name}: calibration due {date} ({due.reason})")
        for text in history.unread:
            say(f"tribolab: {text}", to_stderr=True)
        say(history_verdict(history))
        say(f"page: {page}")
    raise typer.Exit(1 if history.signalling else 0)


def plan(
    results: Annotated[Path, typer.Argument(help="Results folder of a pilot study.")],
    standard_error: Annotated[
        float | None, leaving("--standard-error", "state --half-interval (U95 of the mean)")
    ] = None,
    half_interval: Annotated[
        float | None,
        typer.Option(
            min=0, help="U95 of the mean coefficient to reach, e.g. 0.005.", show_default=False
        ),
    ] = None,
    assurance: Annotated[
        float,
        typer.Option(
            min=0.5,
            max=0.999,
            help="Probability of reaching it with the number of runs called assured.",
        ),
    ] = 0.8,
    setup_time: Annotated[
        str, typer.Option(help="Time that each run takes in addition to sliding.")
    ] = "10 min",
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Output folder for the page and its table.")
    ] = Path("lab"),
    debug: Debug = False,
) -> None:
    """Plan sliding time and number of runs from the scatter of a pilot campaign.

    Computes, for each speed, the number of runs that reaches a precision with 50 % probability and
    with assurance, for the pilot's sliding time and for the cheapest one.

        tribolab lab plan results --half-interval 0.005 --assurance 0.95 --setup-time "20 min"
    """
    with reported(debug):
        # imported late for a quick start
        from tribolab.comparison.planning import measuring_plan, plan_text
        from tribolab.comparison.planning_page import write_plan
        from tribolab.units.conversion import to_si

        if (standard_error is None) == (half_interval is None):
            raise ConfigError("state the precision to reach, e.g. --half-interval 0.005")
        made = measuring_plan(
            results,
            standard_error=standard_error,
            half_interval=half_interval,
            assurance=assurance,
            setup_time=to_si(setup_time, "s", name="setup time"),
        )
        page = write_plan(made, f"Plan after {results.resolve().parent.name}", output)
        say(plan_text(made))
        say(f"page: {page}")
