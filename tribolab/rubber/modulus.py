"""Complex modulus of rubber as a function of frequency: fractional Zener model or table."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from tribolab.core.errors import AnalysisError
from tribolab.reading.moduli import read_modulus_table
from tribolab.units.conversion import positive


class Modulus(Protocol):
    """Type of a function that returns the complex modulus E [Pa] at angular frequencies [rad/s]."""

    def __call__(self, angular_frequency: ArrayLike) -> np.ndarray:
        """Return the complex modulus [Pa], with E(-omega) = conj(E(omega))."""
        ...


@dataclass(frozen=True)
class FractionalZener:
    """Fractional Zener solid: rubbery and glassy plateaus, joined by a power-law transition.

    Parameters
    ----------
    relaxed, unrelaxed
        Modulus of the rubber at zero and of the glass at infinite frequency [Pa].
    relaxation_time
        tau [s]; the loss modulus is largest at omega = 1/tau.
    exponent
        alpha [1], above 0 and at most 1; 1 is the standard linear solid.

    Notes
    -----
    ``E = E_0 + (E_inf - E_0) z/(1 + z)``, ``z = (i omega tau)^alpha``: analytic in the half-plane
    required by causality, so that storage and loss obey the Kramers-Kronig relations.

    Examples
    --------
    >>> solid = FractionalZener("1.5 MPa", "1 GPa", "1 ns", 0.5)
    >>> complex(solid(0.0))
    (1500000+0j)
    """

    relaxed: float
    unrelaxed: float
    relaxation_time: float
    exponent: float

    def __post_init__(self) -> None:
        """Convert text to SI values and raise an error if one is impossible."""
        for name, unit in (("relaxed", "Pa"), ("unrelaxed", "Pa"), ("relaxation_time", "s")):
            object.__setattr__(self, name, positive(getattr(self, name), unit, name))
        if self.unrelaxed < self.relaxed:
            raise AnalysisError(
                f"unrelaxed: the glass cannot be softer than the rubber; got {self.unrelaxed:g} "
                f"below {self.relaxed:g} Pa"
            )
        if not 0 < self.exponent <= 1:
            raise AnalysisError(
                f"exponent: a value above 0 and at most 1 is wanted; got {self.exponent:g}"
            )

    def __call__(self, angular_frequency: ArrayLike) -> np.ndarray:
        """Return the complex modulus [Pa] at angular frequencies [rad/s] (any shape)."""
        omega = np.asarray(angular_frequency, dtype=float)
        turn = np.exp(0.5j * np.pi * self.exponent)
        z = (np.abs(omega) * self.relaxation_time) ** self.exponent * turn
        modulus = self.relaxed + (self.unrelaxed - self.relaxed) * z / (1 + z)
        return np.where(omega < 0, np.conj(modulus), modulus)


# Substitute for PDMS at 20 C: Xu et al. (2026) show its modulus only as a plot. Plateaus as they
# state, with an interpolation between rubber and glass; a glass-transition frequency of 1e9 Hz
# and an exponent of one half are usual for PDMS networks. Valid for orders of magnitude only.
PDMS_STAND_IN = FractionalZener(1.5e6, 1e9, 1e-10, 0.5)


@dataclass(frozen=True, eq=False)
class TabulatedModulus:
    """Measured complex modulus, interpolated in the logarithm of the frequency.

    Between entries storage and loss are power laws of the frequency (linear in its logarithm if the
    loss is not positive). Outside the table the storage modulus is constant, and the loss falls as
    omega below and as 1/omega above, as for one relaxation.

    Parameters
    ----------
    angular_frequency
        [rad/s], strictly increasing, positive (n).
    storage, loss
        E' and E'' [Pa] (n).
    remarks
        Assumptions made when its file was read.
    """

    angular_frequency: np.ndarray = field(repr=False)
    storage: np.ndarray = field(repr=False)
    loss: np.ndarray = field(repr=False)
    remarks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Check the table, and store read-only copies."""
        for name in ("angular_frequency", "storage", "loss"):
            values = np.array(getattr(self, name), dtype=float)
            values.flags.writeable = False
            object.__setattr__(self, name, values)
        omega, storage, loss = self.angular_frequency, self.storage, self.loss
        if omega.ndim != 1 or omega.size < 2 or not omega.shape == storage.shape == loss.shape:
            raise AnalysisError("modulus: three columns of equal length, two or more rows, wanted")
        if not (np.all(np.diff(omega) > 0) and omega[0] > 0):
            raise AnalysisError("modulus: frequencies must be positive and increase strictly")
        if not (np.all(storage > 0) and np.all(np.isfinite(storage + loss)) and np.all(loss >= 0)):
            raise AnalysisError("modulus: E' must be positive, E'' not negative, both finite")

    def __call__(self, angular_frequency: ArrayLike) -> np.ndarray:
        """Return the complex modulus [Pa] at angular frequencies [rad/s] (any shape)."""
        omega = np.asarray(angular_frequency, dtype=float)
        size, ends = np.abs(omega), self.angular_frequency[[0, -1]]
        at, nodes = np.log(np.clip(size, *ends)), np.log(self.angular_frequency)
        storage = np.exp(np.interp(at, nodes, np.log(self.storage)))
        if np.all(self.loss > 0):
            loss = np.exp(np.interp(at, nodes, np.log(self.loss)))
        else:
            loss = np.interp(at, nodes, self.loss)
        loss = loss * np.minimum(size / ends[0], 1) * ends[1] / np.maximum(size, ends[1])
        return storage + 1j * np.sign(omega) * loss

    @property
    def continued(self) -> Modulus:
        """Return the modulus extrapolated by the power laws of the table's first and last decade.

        Results that differ with this modulus depend on frequencies outside the table.
        """
        return _ExtrapolatedModulus(self)


@dataclass(frozen=True, eq=False)
class _ExtrapolatedModulus:
    """Measured modulus, extrapolated by power laws up to a glassy plateau."""

    table: TabulatedModulus

    def __call__(self, angular_frequency: ArrayLike) -> np.ndarray:
        """Return the complex modulus [Pa] at angular frequencies [rad/s] (any shape)."""
        size, table = np.abs(np.asarray(angular_frequency, dtype=float)), self.table
        nodes, moduli = np.log(table.angular_frequency), []
        with np.errstate(divide="ignore"):
            at = np.log(size)
        for values in (table.storage, np.maximum(table.loss, 1e-6 * table.storage)):
            logs = np.log(values)
            inside = np.interp(at, nodes, logs)
            for end, near in (
                (0, nodes <= nodes[0] + _DECADE),
                (-1, nodes >= nodes[-1] - _DECADE),
            ):
                near[[end, 1 if end == 0 else -2]] = True
                slope = float(np.clip(np.polyfit(nodes[near], logs[near], 1)[0], 0.0, 1.0))
                beyond = at < nodes[0] if end == 0 else at > nodes[-1]
                inside = np.where(beyond, logs[end] + slope * (at - nodes[end]), inside)
            moduli.append(np.minimum(np.exp(inside), max(_GLASS, float(values.max()))))
        return moduli[0] + 1j * np.sign(angular_frequency) * moduli[1]


_DECADE = np.log(10.0)
_GLASS = 3e9  # Pa, upper limit of the glassy modulus of polymers


def read_modulus(
    path: str | Path,
    sweep: int | str | None = None,
    sheet: str | None = None,
    unit: str | None = None,
) -> TabulatedModulus:
    r"""Return a table of storage and loss modulus, read from a file of a rheometer or DMA.

    Parameters
    ----------
    path, sweep, sheet, unit
        As for `tribolab.reading.moduli.read_modulus_table`: text or workbook, which of several
        sweeps (its number from 0, or its temperature), which sheet, and the unit of moduli that
        the file does not state.

    Returns
    -------
    TabulatedModulus
        Sorted by frequency, in rad/s and Pa; a shear modulus is multiplied by 3.

    Raises
    ------
    ReadError
        If a column or its unit is missing, or the file has several sweeps and none is chosen.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "pdms.csv"
    ...     _ = file.write_text("f,E_stor,E_loss\nHz,MPa,MPa\n0.1,1.5,0.1\n10,1.8,0.3\n")
    ...     read_modulus(file).storage
    array([1500000., 1800000.])
    """
    table = read_modulus_table(path, sweep, sheet, unit)
    return TabulatedModulus(*table[:3], remarks=table.remarks)
