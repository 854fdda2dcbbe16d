"""Simulated campaign on disk: raw files, campaign.toml and the true values."""

from __future__ import annotations

import contextlib
import datetime as dt
import json
import multiprocessing
import shutil
import tempfile
import zlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from tribolab.contact.work_of_adhesion import PDMS_PMMA_GLYCEROL, work_of_adhesion_spread
from tribolab.core.errors import ConfigError
from tribolab.core.untyped import Json
from tribolab.rig.faults import Fault
from tribolab.rig.files import FIRST_DAY, write_run, write_scans
from tribolab.rig.laws import friction_law
from tribolab.rig.parameters import Rig
from tribolab.rig.runs import run_name, simulate_run
from tribolab.rig.scans.faults import ScanFault
from tribolab.rig.scans.faulty import fault_of_campaign, write_faulty_scans
from tribolab.rig.scans.profiles import scans
from tribolab.studies import xu2026

Law = Callable[[np.ndarray], np.ndarray]
_NOTE = (
    "Simulated by a virtual rig, not measured. The surfaces are generated with the roughness and "
    "slope given by Xu et al. (2026); their measured spectra are not published."
)
_SMALL_SPEEDS = (4.64e-6, 1e-4, 2.15e-3)


@dataclass(frozen=True)
class _Condition:
    surface: str
    medium: str
    normal_force: float


@dataclass(frozen=True)
class _Job:
    """One run, or all scans of one surface, to be simulated (perhaps in another process)."""

    folder: Path
    seed: int
    rig: Rig
    condition: _Condition
    number: int  # number of the repeat; 0 for the scans of the surface
    scans: int
    date: dt.datetime
    faults: tuple[str, ...] = ()
    law: Law | None = None


def simulate_campaign(
    folder: str | Path,
    seed: int = 0,
    *,
    small: bool = False,
    surfaces: Sequence[str] | None = None,
    loads: Sequence[float] | None = None,
    n_repeats: int = 2,
    n_scans: int | None = None,
    rig: Rig | None = None,
    faults: str | Sequence[str] = (),
    progress: Callable[[str, int, int], None] | None = None,
    jobs: int = 1,
    executor: Executor | None = None,
) -> Path:
    """Write a simulated campaign: raw files of runs and scans, campaign.toml and the truth.

    Parameters
    ----------
    folder
        Target folder; must not exist, or be empty.
    seed
        The same seed gives the same files, regardless of `jobs`.
    small
        A few runs at three speeds, for a first look and for tests.
    surfaces, loads
        Names of surfaces and normal forces [N]; by default all of Xu et al. Runs in glycerol have
        every load, dry runs the lowest.
    n_repeats, n_scans
        Runs per condition, scans per surface.
    rig
        Protocol and sensors.
    faults
        Names of faults of runs (`tribolab.rig.faults.FAULTS`), each of which affects one run; and
        of scans (`tribolab.rig.scans.faulty.SCAN_FAULTS_BY_NAME`), each of which affects the scans
        of one surface. The truth lists the affected files.
    progress
        Called as ``progress(stage, done, total)``.
    jobs
        Number of processes.
    executor
        Any `concurrent.futures.Executor` to work in, instead of `jobs`.

    Returns
    -------
    pathlib.Path
        The ``campaign.toml``, next to ``raw/friction``, ``raw/profiles`` and ``truth``.

    Raises
    ------
    ConfigError
        If the folder is not empty, or if a fault is unknown or suits no run.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = simulate_campaign(Path(folder) / "demo", small=True, surfaces=["Sb-R"])
    ...     sorted(item.name for item in path.parent.iterdir())
    ['campaign.toml', 'raw', 'truth']
    """
    target = Path(folder)
    if target.exists() and (not target.is_dir() or any(target.iterdir())):
        raise ConfigError(
            f"{target} exists and is not an empty folder; name a new one, nothing is overwritten"
        )
    rig = rig or Rig()
    if small:
        surfaces, loads = surfaces or ("Smooth", "Sb-R"), loads or xu2026.system.loads[:1]
        n_scans = n_scans or 1
        if rig.protocol.speeds == xu2026.SPEEDS:
            rig = replace(rig, protocol=replace(rig.protocol, speeds=_SMALL_SPEEDS))
    names = [xu2026.surface(name).name for name in surfaces or xu2026.surfaces]
    forces = sorted(float(load) for load in loads or xu2026.system.loads)
    conditions = [
        *(_Condition(name, "glycerol", force) for name in names for force in forces),
        *(_Condition(name, "dry", forces[0]) for name in names),
    ]
    n_scans = n_scans or xu2026.profilometer.scans

    target.parent.mkdir(parents=True, exist_ok=True)
    # written to a temporary folder first, so that a killed simulation leaves no partial campaign
    aside = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.parent))
    try:
        for room in ("raw/friction", "raw/profiles", "truth"):
            (aside / room).mkdir(parents=True)
        work = list(_jobs(aside, seed, rig, names, conditions, n_repeats, n_scans))
        work = _assign_faults([faults] if isinstance(faults, str) else faults, work)
        pool = contextlib.nullcontext(executor) if executor else _processes(jobs)
        with pool as working:
            facts = _run_all(work, working, progress)
        _write_facts(aside, seed, rig, names, facts)
        (aside / "campaign.toml").write_text(
            campaign_text(names, conditions), encoding="utf-8", newline="\n"
        )
        aside.chmod(0o755)
        if target.exists():
            target.rmdir()
        aside.rename(target)
    except BaseException:
        shutil.rmtree(aside, ignore_errors=True)
        raise
    return target / "campaign.toml"


def _jobs(
    folder: Path,
    seed: int,
    rig: Rig,
    names: Iterable[str],
    conditions: Iterable[_Condition],
    n_repeats: int,
    n_scans: int,
) -> Iterator[_Job]:
    made = 0
    for condition in conditions:
        for number in range(1, n_repeats + 1):
            yield _Job(folder, seed, rig, condition, number, n_scans, _date(made))
            made += 1
    for name in names:
        yield _Job(folder, seed, rig, _Condition(name, "", 0.0), 0, n_scans, _date(made))


def _assign_faults(faults: Sequence[str], work: list[_Job]) -> list[_Job]:
    """Return the jobs with faults; each fault goes to a suitable job with fewest faults so far."""
    for name in faults:
        fault = fault_of_campaign(name)
        able = [k for k, job in enumerate(work) if _can_have(job, fault)]
        if not able:
            where = f"{fault.surface} {fault.medium} only" if isinstance(fault, Fault) else "scans"
            raise ConfigError(
                f"fault '{name}' happens on {where}, and the campaign has no such run"
            )
        k = min(able, key=lambda k: len(work[k].faults))
        fewest = fault.fewest if isinstance(fault, ScanFault) else 0
        n_scans = max(work[k].scans, fewest)
        work[k] = replace(work[k], faults=(*work[k].faults, name), scans=n_scans)
    return work


def _can_have(job: _Job, fault: Fault | ScanFault) -> bool:
    """Whether a fault can occur in a job, which is a run or (number 0) the scans of a surface."""
    if isinstance(fault, ScanFault):
        return not job.number
    return bool(job.number) and fault.suits(job.condition.surface, job.condition.medium)


def _date(made: int) -> dt.datetime:
    """Return the start time of the n-th run of a campaign with eight runs a day."""
    day, turn = divmod(made, 8)
    return FIRST_DAY + dt.timedelta(days=day, minutes=52 * turn, seconds=17 * turn)


def _processes(jobs: int) -> contextlib.AbstractContextManager[Executor | None]:
    if jobs <= 1:
        return contextlib.nullcontext()
    # spawn, because a forked child would inherit locks of the parent's threads
    return ProcessPoolExecutor(jobs, mp_context=multiprocessing.get_context("spawn"))


def _run_all(
    work: list[_Job], pool: Executor | None, progress: Callable[[str, int, int], None] | None
) -> dict[str, Json]:
    """Run all simulations, here or in other processes, and return the true values by file."""
    do = pool.map if pool else map
    conditions = list(dict.fromkeys(job.condition for job in work if job.number))
    # each friction law is computed once, because all repeats use it
    laws = dict(zip(conditions, do(_law, conditions), strict=True))
    work = [replace(job, law=laws.get(job.condition)) for job in work]
    facts: dict[str, Json] = {"runs": {}, "scans": {}}
    for done, (job, (name, fact)) in enumerate(zip(work, do(_do, work), strict=True), start=1):
        if job.number:
            facts["runs"][name] = fact
        else:
            facts["scans"].update(fact)
        if progress:
            progress("simulate", done, len(work))
    return facts


def _law(condition: _Condition) -> Law:
    return friction_law(condition.surface, condition.medium, condition.normal_force)


def _do(job: _Job) -> tuple[str, Json]:
    """Write the files of one run, or the scans of one surface, and return their true values."""
    c = job.condition
    if not job.number:
        stem = c.surface.lower()
        data = scans(c.surface, job.scans, seed=_generator(job.seed, stem))
        folder = job.folder / "raw/profiles"
        if not job.faults:
            write_scans(data, folder)
            return stem, {}
        # faults have their own random numbers, so that all else equals the scans without faults
        rng = _generator(job.seed, f"{stem} faults")
        return stem, write_faulty_scans(data, job.faults, folder, rng)
    name = run_name(c.surface, c.medium, c.normal_force, job.number)
    run = simulate_run(
        c.surface,
        c.medium,
        c.normal_force,
        job.number,
        seed=_generator(job.seed, name),
        rig=job.rig,
        law=job.law,
        faults=job.faults,
    )
    write_run(run, job.folder / "raw/friction", job.date)
    table = run.segments.to_csv(index=False, lineterminator="\n", float_format="%.10g")
    (job.folder / "truth" / f"{name}.csv").write_text(table, encoding="utf-8", newline="\n")
    return name, run.facts


def _generator(seed: int, name: str) -> np.random.Generator:
    """Return a random generator that depends only on the seed and the name of a run."""
    return np.random.default_rng([seed, zlib.crc32(name.encode())])


def _write_facts(
    folder: Path, seed: int, rig: Rig, names: Sequence[str], facts: dict[str, Json]
) -> None:
    # imported late: the import looks up the installed package
    from tribolab.version import __version__

    text = json.dumps(
        {
            "schema_version": 1,
            "tribolab_version": __version__,
            "seed": seed,
            "system": asdict(xu2026.system),
            "rig": asdict(rig),
            "surfaces": {
                name: {"origin": xu2026.STAND_IN, **asdict(xu2026.surface(name))} for name in names
            },
            "references": xu2026.CITATION,
            **facts,
        },
        indent=1,
        allow_nan=False,
    )
    (folder / "truth" / "truth.json").write_text(text + "\n", encoding="utf-8", newline="\n")


def campaign_text(names: Sequence[str], conditions: Sequence[_Condition]) -> str:
    """Return the text of the campaign file for given surfaces and conditions."""
    s = xu2026.system
    parts = [
        "# Simulated by the virtual rig of tribolab; the truth lies in truth/.\n"
        f"# After {xu2026.CITATION}.\n"
        "[campaign]\n"
        'name = "PMMA on PDMS, dry and in glycerol (virtual rig)"\n'
        'raw = "raw"\n'
        f'note = "{_NOTE}"\n',
        "[contact]\n"
        f'radius = "{100 * s.radius:g} cm"\n'
        f'length = "{100 * s.length:g} cm"\n'
        f'youngs_modulus = "{s.youngs_modulus / 1e6:g} MPa"\n'
        f"poisson_ratio = {s.poisson_ratio:g}\n",
        f'[medium.glycerol]\nviscosity = "{s.viscosity:g} Pa s"\nwork_of_adhesion = "51 mJ/m^2"\n'
        f"{_range('wet')}",
        f'[medium.dry]\nwork_of_adhesion = "64 mJ/m^2"\n{_range("dry")}',
        "[segments]\ntrim = 0.10\n",
    ]
    parts += [
        f'[[surface]]\nname = "{name}"\nscans = "profiles/{name.lower()}_*.csv"\n' for name in names
    ]
    for c in conditions:
        stem = run_name(c.surface, c.medium, c.normal_force, 1).removesuffix("01")
        parts.append(
            f'[[run]]\nfiles = "friction/{stem}*.csv"\nsurface = "{c.surface}"\n'
            f'medium = "{c.medium}"\nnormal_force = "{c.normal_force:g} N"\n'
            'instrument = "linear_slider"\n'
        )
    return "\n".join(parts)


def _range(medium: str) -> str:
    """Return the line of the campaign file with the bounds of the work of adhesion in a medium."""
    spread = work_of_adhesion_spread(PDMS_PMMA_GLYCEROL, samples=2).sel(medium=medium)
    ends = (1e3 * float(spread[f"work_of_adhesion_{end}"]) for end in ("low", "high"))
    return "work_of_adhesion_range = [{}]\n".format(", ".join(f'"{x:.1f} mJ/m^2"' for x in ends))
