"""How long each kind of publication figure takes to draw and to save as SVG.

Usage: python tests/benchmarks/bench_figures.py [FOLDER] [repeats] [PICTURES]

Analyses a small simulated campaign without figures (in FOLDER if named, where it is found the next
time: a minute), then has them drawn in this process, each so often (default 3). Prints CPU
milliseconds, the least of the repeats, of the slowest figure of each kind. With PICTURES, the
figures are kept in that folder as PNG, to be looked at.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tribolab import plot, rig
from tribolab.app.run import run_campaign

_NO_FIGURES = {"Trace", "envelope", "figure_data", "paper_style", "save", "svg"}


class Stopwatch:
    """Stands before the functions of `tribolab.plot` and takes their times."""

    def __init__(self, repeats: int, pictures: Path | None) -> None:
        self.repeats, self.pictures = repeats, pictures
        self.times: dict[str, list[tuple[float, float]]] = {}
        self.drawn: tuple[str, Callable[[], Any]] | None = None
        self.save = plot.save

    def stand_before(self, name: str) -> None:
        """Remember each call of a function, to draw the figure again."""
        draw = getattr(plot, name)

        def drawn(*args: Any, **more: Any) -> Any:
            self.drawn = name, lambda: draw(*args, **more)
            return draw(*args, **more)

        setattr(plot, name, drawn)

    def saved(self, figure: Any, path: str | Path) -> Path:
        """Draw and save the figure that was drawn last, several times."""
        if self.drawn is None or Path(path).suffix != ".svg":
            return self.save(figure, path)
        name, draw = self.drawn
        spent = []
        for _ in range(self.repeats):
            begin = time.process_time()
            figure = draw()
            between = time.process_time()
            self.save(figure, path)
            spent.append((between - begin, time.process_time() - between))
        self.times.setdefault(name, []).append(min(spent, key=sum))
        if self.pictures:
            self.save(figure, self.pictures / f"{Path(path).stem}.png")
        return Path(path)


def main() -> None:
    """Print the table."""
    given = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    repeats = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    pictures = Path(sys.argv[3]) if len(sys.argv) > 3 else None
    if pictures:
        pictures.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        folder = given or Path(scratch)
        campaign = folder / "small" / "campaign.toml"
        if not campaign.exists():
            rig.simulate_campaign(campaign.parent, small=True)
        run_campaign(campaign, jobs=1, figures="none")
        watch = Stopwatch(repeats, pictures)
        for name in set(plot.__all__) - _NO_FIGURES:
            watch.stand_before(name)
        plot.save = watch.saved
        run_campaign(campaign, jobs=1, figures="all")
    print(f"{'kind':26s} figures   draw   save    both  [ms of CPU]")
    for name, spent in sorted(watch.times.items(), key=lambda item: -max(map(sum, item[1]))):
        draw, save = max(spent, key=sum)
        print(f"{name:26s} {len(spent):7d} {1e3 * draw:6.0f} {1e3 * save:6.0f} "
              f"{1e3 * (draw + save):7.0f}")  # fmt: skip
    every = [sum(one) for spent in watch.times.values() for one in spent]
    print(f"{'all':26s} {len(every):7d} mean {1e3 * sum(every) / len(every):21.0f}")


if __name__ == "__main__":
    main()
