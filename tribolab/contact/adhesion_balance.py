"""Energy balance of adhesion, Eqs. (11) and (12) of Xu et al. (2026), with the contact area P(q).

The derivative of Eq. (11) is integrated from small to large wavenumbers: the binding energy g(q) =
gamma_eff P increases by the elastic energy of finer roughness, and P(q) decreases where the
diffusing stress reaches the detachment stress, which gamma_eff determines at the same wavenumber.
The only unknown is g at the smallest wavenumber, such that g = gamma_0 P(q1) I(xi) at the largest
one: one bracketed root for each pressure. Solving Eq. (11) in turn for P and gamma_eff has the same
root, but does not converge where gamma_eff(1) begins to exceed zero.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.special import erfcx

from tribolab.contact.area import AreaTheory, area_of
from tribolab.contact.first_passage import Diffusion
from tribolab.contact.guided_root import guided_root
from tribolab.core.errors import AnalysisError
from tribolab.surface.moments import cumulative_at, spectrum_arrays
from tribolab.units.conversion import positive, to_si

# Share of the nodes that is spaced evenly in ln q; the others follow the increase of stress.
_EVEN_SHARE = 0.2
_THINNING = 4  # factor by which the number of nodes is reduced for the first root search
_NEGLIGIBLE = 1e-11  # share of the elastic energy below which adhesion is neglected
_CLOSE_GUESS = 2e-5  # relative error below which a guessed P(q) needs no correction
_SMALLEST_AREA = 1e-15
_LARGEST_RESIDUAL = 1e-8
# Below this share of E* xi/2 the limit p -> 0 is used: the theory is then linear in p, and
# differences of probabilities near 1 lose significant digits.
_SMALL_PRESSURE = 1e-4

March = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


class Balance(NamedTuple):
    """Solution of Eq. (11) at each wavenumber, for k pairs of pressure and work of adhesion."""

    area: np.ndarray  # P(q) [1] (k, n)
    binding: np.ndarray  # gamma_eff [J/m2] (k, n)
    start: np.ndarray  # right-hand side of Eq. (11) at q0, may be negative [J/m2] (k)
    residual: np.ndarray  # misfit of Eq. (11) at q1, relative to its terms (k)
    iterations: np.ndarray  # steps of the root search (k)


@dataclass(frozen=True)
class Interface:
    """Rough surface on an elastic solid, with the terms of Eq. (11) at nodes in wavenumber."""

    wavenumber: np.ndarray  # [rad/m] (n)
    modulus: float  # E* [Pa]
    kappa: float
    c_a: float  # factor of the detachment stress, Eq. (12)
    slope: float  # xi of Eq. (12)
    diffusion: Diffusion
    elastic: np.ndarray  # E*/4 2 pi int q^2 C dq over each step of wavenumber [J/m2] (n - 1)

    @classmethod
    def on_nodes(
        cls,
        q: np.ndarray,
        spectrum: np.ndarray,
        modulus: float,
        *,
        nodes: int,
        kappa: float,
        c_a: float,
    ) -> Interface:
        """Return an interface whose nodes are dense where the stress increases steeply.

        Raises
        ------
        AnalysisError
            If the spectrum is zero everywhere.
        """
        fine = np.union1d(np.geomspace(q[0], q[-1], 4001)[1:-1], q)
        stress = cumulative_at(fine, q, spectrum, 3)
        if not stress[-1] > 0:
            raise AnalysisError("psd: C is zero everywhere, there is no roughness to adhere to")
        # the fourth root puts as many nodes at the first increase of stress as in the last decade
        even = np.log(fine / q[0]) / np.log(q[-1] / q[0])
        measure = _EVEN_SHARE * even + (1 - _EVEN_SHARE) * (stress / stress[-1]) ** 0.25
        node = np.exp(np.interp(np.linspace(0, 1, nodes), measure, np.log(fine)))
        node[0], node[-1] = q[0], q[-1]
        cubic = cumulative_at(node, q, spectrum, 3)
        return cls(
            wavenumber=node,
            modulus=modulus,
            kappa=kappa,
            c_a=c_a,
            slope=float(np.sqrt(2 * np.pi * cubic[-1])),
            diffusion=Diffusion.over(np.pi / 2 * modulus**2 * np.maximum.accumulate(cubic)),
            elastic=np.pi / 2 * modulus * np.diff(cumulative_at(node, q, spectrum, 2)),
        )

    @property
    def small_pressure(self) -> float:
        """Pressure [Pa] for evaluating the limit p -> 0: 1e-4 of the stress scale E* xi/2."""
        return _SMALL_PRESSURE * float(np.sqrt(self.diffusion.time[-1]))

    @property
    def area_gain(self) -> float:
        """Ratio of true to projected area, int (1 + xi^2 x)^(1/2) exp(-x) dx in Eq. (11)."""
        return float(1 + np.sqrt(np.pi) / 2 * self.slope * erfcx(1 / self.slope))

    def without_adhesion(self, pressure: np.ndarray, theory: AreaTheory = "persson") -> np.ndarray:
        """Return P(q) without adhesion at the nodes (k, n): Eqs. (6), (7) or another theory."""
        with np.errstate(divide="ignore", invalid="ignore"):
            area = area_of(pressure[:, None] / np.sqrt(2 * self.diffusion.time), theory)
        area[:, 0] = 1.0
        return area

    def reduced(self, area: np.ndarray) -> np.ndarray:
        """Return S(q) P(q), the share of the elastic energy that is stored at each wavenumber."""
        return area * (self.kappa + (1 - self.kappa) * area * area)

    def march(self, start: np.ndarray, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return P and g = gamma_eff P, integrated from q0 to q1.

        Parameters
        ----------
        start
            g at q0 [J/m2] (k); if negative, gamma_eff is zero until g exceeds zero.
        pressure
            Nominal pressure [Pa] (k).

        Returns
        -------
        tuple of numpy.ndarray
            P [1] and g [J/m2], both (n, k).
        """
        n = self.wavenumber.size
        area, energy = np.ones((n, start.size)), np.empty((n, start.size))
        levels, losses = np.empty((n - 1, start.size)), np.empty((n - 1, start.size))
        energy[0] = start
        stiffness = self.c_a**2 * self.modulus * self.wavenumber
        height = -np.sqrt(np.maximum(start, 0.0) * stiffness[0])
        for i in range(n - 1):
            before, stored = area[i], self.reduced(area[i])
            # first guess of P at the next node: a parabola through ln P at the last three nodes, or
            # constant at the start; a guess that is inaccurate is corrected
            guess = before
            if i > 0:
                ratio = before / area[i - 1]
                bend = area[i - 2] / area[i - 1] * ratio if i > 1 else 1.0
                guess = before * np.clip(ratio * bend, 0.5, 1.0)
            which: np.ndarray | slice = slice(None)
            for _ in range(2):
                grown = (
                    energy[i][which]
                    + self.elastic[i] * (stored[which] + self.reduced(guess[which])) / 2
                )
                below = -np.sqrt(np.maximum(grown, 0.0) / guess[which] * stiffness[i + 1])
                levels[i, which] = (height[which] + below) / 2
                losses[i, which] = self.diffusion.lost(
                    i, levels[i, which], pressure[which], levels[:i, which], losses[:i, which]
                )
                expected = guess
                guess = np.maximum(before - losses[i], _SMALLEST_AREA)
                which = np.flatnonzero(np.abs(guess - expected) > _CLOSE_GUESS * guess)
                if not which.size:
                    break
            area[i + 1] = guess
            energy[i + 1] = energy[i] + self.elastic[i] * (stored + self.reduced(guess)) / 2
            height = -np.sqrt(np.maximum(energy[i + 1], 0.0) / guess * stiffness[i + 1])
        return area, energy

    def stored(self, area: np.ndarray) -> np.ndarray:
        """Return the elastic energy [J/m2] (k) stored by a contact area P(q) (k, n)."""
        reduced = self.reduced(area)
        return np.asarray((self.elastic * (reduced[:, 1:] + reduced[:, :-1]) / 2).sum(axis=1))

    def thinned(self) -> Interface:
        """Return the interface on every fourth node, including both ends."""
        kept = np.unique(np.append(np.arange(0, self.wavenumber.size - 1, _THINNING), -1))
        kept = np.append(kept[1:], self.wavenumber.size - 1)
        return replace(
            self,
            wavenumber=self.wavenumber[kept],
            diffusion=Diffusion.over(self.diffusion.time[kept]),
            elastic=np.add.reduceat(self.elastic, kept[:-1]),
        )

    def solve(self, pressure: np.ndarray, work: np.ndarray, iterations: int) -> Balance:
        """Return the solution of Eq. (11) for each problem (k), by a root search for g at q0.

        The bracket extends from no adhesion at any wavenumber to the largest gamma_eff(1) that
        Eq. (11) allows. The first search uses only a quarter of the nodes. `pressure` and `work`
        must be above zero.
        """
        unit, gained = self.stored(self.without_adhesion(pressure)), work * self.area_gain
        area, energy = np.empty((2, self.wavenumber.size, unit.size))

        def misfit(march: March) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
            def at(x: np.ndarray, which: np.ndarray) -> np.ndarray:
                start = np.sinh(x) * unit[which]
                marched = march(start, pressure[which])
                if march == self.march:
                    area[:, which], energy[:, which] = marched
                (whole, bound), most = (part[-1] for part in marched), gained[which]
                return (bound - most * whole) / (unit[which] + most * whole)

            return at

        # an asinh scale finds tiny roots (small pressure) as fast as large ones
        low, high = np.full_like(unit, np.arcsinh(-1.0)), np.arcsinh(gained / unit)
        root = guided_root(misfit(self.march), misfit(self.thinned().march), low, high, iterations)
        binding = np.maximum(energy, 0.0) / area
        start = np.sinh(root.x) * unit
        return Balance(area.T, binding.T, start, np.abs(root.value), root.steps)


def rough_interface(
    psd: xr.Dataset, effective_modulus: str | float, kappa: float, c_a: float, nodes: int
) -> Interface:
    """Return the interface of a spectrum and an elastic modulus, after checks of its parameters.

    Raises
    ------
    AnalysisError
        If a parameter or the spectrum is invalid.
    """
    if not 0 <= kappa <= 1:
        raise AnalysisError(f"kappa: a value from 0 to 1 is wanted; got {kappa:g}")
    if not 0 <= c_a < np.inf:
        raise AnalysisError(
            f"a value of about 1, zero or above, is wanted; got {c_a:g}", function="c_a"
        )
    if nodes < 50:
        raise AnalysisError(f"nodes: at least 50 are needed, 200 are usual; got {nodes}")
    modulus = positive(effective_modulus, "Pa", "effective_modulus")
    q, spectrum = spectrum_arrays(psd)
    return Interface.on_nodes(q, spectrum, modulus, nodes=int(nodes), kappa=kappa, c_a=c_a)


def work_value(work_of_adhesion: str | float) -> float:
    """Return a work of adhesion [J/m2] from text or a number; an error if it is negative.

    Raises
    ------
    AnalysisError
        If the work of adhesion is negative or not finite.
    """
    given = work_of_adhesion if isinstance(work_of_adhesion, str) else float(work_of_adhesion)
    work = to_si(given, "J/m^2", name="work_of_adhesion")
    if not 0 <= work < np.inf:
        raise AnalysisError(
            f"work_of_adhesion: zero or above is wanted; got {work:g} J/m2. Where Eq. (14) gives a "
            "negative value the liquid wets and keeps the solids apart: there is no adhesion, use 0"
        )
    return work


def balance(
    surface: Interface, pressure: np.ndarray, work: np.ndarray, max_iterations: int
) -> Balance:
    """Return the energy balance of Eq. (11) at each pressure and work of adhesion (k).

    Zero work of adhesion gives Eqs. (6) and (7), a NaN pressure gives NaN.

    Raises
    ------
    AnalysisError
        If the equation is not fulfilled; the message gives the pressure and the argument to change.
    """
    k, n = pressure.size, surface.wavenumber.size
    area, binding = surface.without_adhesion(pressure), np.zeros((k, n))
    start, residual, iterations = np.zeros(k), np.zeros(k), np.zeros(k, dtype=int)
    unknown = np.isnan(pressure)
    area[unknown], binding[unknown], residual[unknown] = np.nan, np.nan, np.nan
    # adhesion negligible compared with the elastic energy: use the solution without adhesion
    felt = work * surface.area_gain * area[:, -1] > _NEGLIGIBLE * surface.stored(area)
    todo = felt & ~unknown
    if todo.any():
        part = surface.solve(pressure[todo], work[todo], max_iterations)
        worst = int(np.argmax(np.where(np.isnan(part.residual), np.inf, part.residual)))
        if not part.residual[worst] <= _LARGEST_RESIDUAL:
            raise AnalysisError(
                f"adhesion: Eq. (11) is not solved at p = {pressure[todo][worst]:.4g} Pa and "
                f"gamma_0 = {work[todo][worst]:.4g} J/m2: after {part.iterations[worst]} steps its "
                f"relative misfit is {part.residual[worst]:.2g} and {_LARGEST_RESIDUAL:g} is "
                f"wanted; raise max_iterations (now {max_iterations}) or nodes (now {n})"
            )
        area[todo], binding[todo], start[todo] = part.area, part.binding, part.start
        residual[todo], iterations[todo] = part.residual, part.iterations
    return Balance(area, binding, start, residual, iterations)


def parameters(surface: Interface) -> dict[str, float | int]:
    """Return the parameters of an adhesion calculation, as attributes of its result."""
    return {
        "effective_modulus_Pa": surface.modulus,
        "kappa": surface.kappa,
        "c_a": surface.c_a,
        "nodes": surface.wavenumber.size,
        "rms_slope": surface.slope,
    }
