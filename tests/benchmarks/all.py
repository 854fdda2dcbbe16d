"""Run the benchmarks and write docs/benchmarks.md: machine, versions, and a table of ratios.

    PYTHONPATH=$PWD python tests/benchmarks/all.py [--long] [names]

Each benchmark alternates between tribolab and its peer in one process; nothing else should be
running. ``--long`` adds those of minutes: campaigns of hundreds of runs, records of 1e7 rows.
"""

from __future__ import annotations

import argparse
import os
import platform
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

HERE = Path(__file__).resolve().parent
PROJECT = HERE.parents[1]
PAGE = PROJECT / "docs" / "benchmarks.md"
LONG = {"bench_big_run", "bench_one_run", "bench_scale", "bench_report"}
LONG |= {"bench_adhesion", "bench_contact", "bench_stribeck"}  # solvers, without a peer
LIBRARIES = ("numpy", "scipy", "pandas", "xarray", "polars", "SurfaceTopography", "matplotlib")


def benchmark(script: Path) -> str:
    """Return the output of a benchmark; if it failed, its last words."""
    one_thread = {
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "PYTHONPATH": f"{PROJECT}{os.pathsep}{PROJECT / 'tests'}",
    }
    done = subprocess.run(
        [sys.executable, script], capture_output=True, text=True, env=os.environ | one_thread
    )
    if not done.returncode:
        return done.stdout
    last = done.stderr.strip().splitlines()[-1:] or [""]
    return f"{done.stdout}| {script.stem} | exit code {done.returncode} | {last[0]} | | | |\n"


def versions() -> str:
    """Return the versions of the libraries that are installed."""
    known = []
    for name in LIBRARIES:
        try:
            known.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            known.append(f"{name} not installed")
    return ", ".join(known)


def processor() -> str:
    """Return the name of the processor, as the system states it."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.is_file() else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return f"{names[0] if names else platform.processor()}, {os.cpu_count()} logical cores"


def main() -> None:
    """Run the benchmarks, print each as it ends, and write the page."""
    parse = argparse.ArgumentParser(description=__doc__)
    parse.add_argument("names", nargs="*", help="scripts to run (default: all short ones)")
    parse.add_argument("--long", action="store_true")
    asked = parse.parse_args()
    scripts = sorted(HERE.glob("bench_*.py"))
    if asked.names:
        scripts = [script for script in scripts if script.stem in asked.names]
    elif not asked.long:
        scripts = [script for script in scripts if script.stem not in LONG]
    parts = [
        "# Benchmarks\n",
        "Written by `python tests/benchmarks/all.py`. Each benchmark runs tribolab and its peer (a "
        "reference computation) in turn. Ratio: tribolab divided by peer. Times depend on the "
        "machine; ratios hardly do.\n",
        f"{processor()}; Python {platform.python_version()}; {versions()}\n",
        "| job | tribolab | peer | peer's | ratio | goal |\n|---|---|---|---|---|---|",
    ]
    for script in scripts:
        text = benchmark(script)
        print(f"{script.stem}\n{text}", flush=True)
        parts += [line for line in text.splitlines() if line.startswith("|")]
    PAGE.write_text("\n".join(parts) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
