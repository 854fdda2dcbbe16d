"""Names of the modules that a pool of processes imports before its first task."""

FILES = (
    "tribolab.app.plain",
    "tribolab.app.checks",
    "tribolab.qc.scan.sets",
    "tribolab.reading.scan_files",
)

SIMULATION = ("tribolab.app.plain", "tribolab.rig.campaign", "scipy.linalg")

# first the module with all stages, then the modules that the stages import late
ANALYSIS = (
    "tribolab.app.plain",
    "tribolab.campaign.pipeline",
    "netCDF4",
    "tribolab.reading.unknown_run",
    "tribolab.friction.coefficient.static",
    "tribolab.friction.coefficient.repeatability",
    "tribolab.metrology.dead_weight",
    "tribolab.records.runs.run_facts",
    "tribolab.records.runs.notices",
    "tribolab.report.results",
    "tribolab.reading.scan_files",
    "tribolab.campaign.surfaces.contact",
    "tribolab.campaign.surfaces.scans",
    "tribolab.campaign.models.analysis",
    "tribolab.campaign.joint.work",
    "tribolab.regime.evidence",
    "tribolab.regime.words",
    "matplotlib.backends.backend_svg",
    "tribolab.figures.subjects.curves",
    "tribolab.figures.look.drawing",
    "tribolab.figures.subjects.contact",
    "tribolab.figures.subjects.mixed",
    "tribolab.figures.subjects.fits",
    "tribolab.figures.subjects.film",
    "tribolab.figures.subjects.slip",
    "tribolab.figures.subjects.slip_spectrum",
)
