"""Prony series of a viscoelastic modulus, e.g. from master curves or finite-element models."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from tribolab.core.errors import AnalysisError
from tribolab.units.conversion import positive


@dataclass(frozen=True, eq=False)
class PronySeries:
    """Modulus as a relaxed value plus a sum of exponential relaxations.

    Parameters
    ----------
    relaxed
        Modulus E_0 at rest [Pa].
    moduli
        E_k of the relaxations [Pa], not negative (n).
    relaxation_times
        tau_k [s], above zero (n).

    Raises
    ------
    AnalysisError
        If there are not as many moduli as times, or a number is out of its range.

    Notes
    -----
    ``E(omega) = E_0 + sum_k E_k i omega tau_k/(1 + i omega tau_k)``. The glass has the modulus
    E_0 + sum_k E_k. Between times more than a decade apart the loss has artificial dips: use at
    least one relaxation for each decade of frequency.

    Examples
    --------
    >>> solid = PronySeries("1.5 MPa", [1e6, 1e7], [1e-3, 1e-6])
    >>> complex(solid(0.0)), round(float(solid(1e12).real) / 1e6, 3)
    ((1500000+0j), 12.5)
    """

    relaxed: float
    moduli: np.ndarray = field(repr=False)
    relaxation_times: np.ndarray = field(repr=False)

    def __post_init__(self) -> None:
        """Convert text to SI values and raise an error if one is impossible."""
        object.__setattr__(self, "relaxed", positive(self.relaxed, "Pa", "relaxed"))
        for name in ("moduli", "relaxation_times"):
            values = np.array(getattr(self, name), dtype=float)
            values.flags.writeable = False
            object.__setattr__(self, name, values)
        if self.moduli.ndim != 1 or self.moduli.shape != self.relaxation_times.shape:
            raise AnalysisError(
                f"relaxation_times: one for each of the {self.moduli.size} moduli is wanted; got "
                f"{self.relaxation_times.size}"
            )
        if not np.all((self.moduli >= 0) & np.isfinite(self.moduli)):
            raise AnalysisError("moduli: finite values of at least 0 Pa are wanted")
        if not np.all((self.relaxation_times > 0) & np.isfinite(self.relaxation_times)):
            raise AnalysisError("relaxation_times: finite values above 0 s are wanted")

    def __call__(self, angular_frequency: ArrayLike) -> np.ndarray:
        """Return the complex modulus [Pa] at angular frequencies [rad/s] (any shape)."""
        omega = np.asarray(angular_frequency, dtype=float)
        modulus = np.full(omega.shape, self.relaxed, dtype=complex)
        for stiffness, time in zip(self.moduli, self.relaxation_times, strict=True):
            turn = 1j * omega * time
            modulus += stiffness * turn / (1 + turn)
        return modulus
