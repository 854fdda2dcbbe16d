"""Virtual rig: simulated runs, scans and campaigns whose true values are known."""

from tribolab.rig.calibration import Calibration
from tribolab.rig.campaign import simulate_campaign
from tribolab.rig.faults import FAULTS, Fault, inject
from tribolab.rig.files import write_run, write_scans
from tribolab.rig.laws import DryLaw, StickSlip, StribeckLaw, friction_law, stick_slip
from tribolab.rig.mini_traction import MiniTraction, simulate_mini_traction
from tribolab.rig.mixed_law import MixedLaw
from tribolab.rig.parameters import Clocks, Encoder, ForceCell, Loggers, Protocol, Rig, Scatter
from tribolab.rig.runs import simulate_run
from tribolab.rig.scans.profiles import scans
from tribolab.rig.simulated import SimulatedRun, on_one_clock
from tribolab.rig.traces import simulate_trace
from tribolab.rig.truth import Truth, read_truth

__all__ = [
    "FAULTS",
    "Calibration",
    "Clocks",
    "DryLaw",
    "Encoder",
    "Fault",
    "ForceCell",
    "Loggers",
    "MiniTraction",
    "MixedLaw",
    "Protocol",
    "Rig",
    "Scatter",
    "SimulatedRun",
    "StickSlip",
    "StribeckLaw",
    "Truth",
    "friction_law",
    "inject",
    "on_one_clock",
    "read_truth",
    "scans",
    "simulate_campaign",
    "simulate_mini_traction",
    "simulate_run",
    "simulate_trace",
    "stick_slip",
    "write_run",
    "write_scans",
]
