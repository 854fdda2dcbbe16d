"""Parameters of a lubricated contact: liquid, interface and solver."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, Literal, NamedTuple, ParamSpec, TypeVar, get_args

import numpy as np

from tribolab.arrays.broadcasting import stated_value
from tribolab.contact.area import AreaTheory, check_area
from tribolab.contact.separation import Separation
from tribolab.core.errors import AnalysisError, nearest, shown
from tribolab.lubrication.factors import FlowFactors, RoughBody
from tribolab.lubrication.thinning import ShearThinning
from tribolab.units.conversion import positive, to_si

P = ParamSpec("P")
R = TypeVar("R")
Outlet = Literal["vented", "flooded"]
Abscissa = Literal["entrainment_speed", "sliding_speed"]
Method = Literal["auto", "full", "strips"]
VAPOUR = -1e5  # Pa: a degassed liquid boils at some 1 bar below ambient pressure


def _require_known(name: str, value: str, kind: Any) -> None:
    known = list(get_args(kind))
    if value not in known:
        raise AnalysisError(f"{name}: '{shown(value)}' is not known{nearest(value, known)}")


@dataclass(frozen=True)
class Liquid:
    """Liquid between the bodies: viscosity, extent and pressure of its cavity.

    Parameters
    ----------
    viscosity
        eta [Pa s]; for a shear-thinning liquid eta_0, at zero shear rate.
    extent
        Distance [m] from the contact's middle at which the liquid begins; for a ball, at which it
        ends. None: liquid everywhere for a line contact, up to the ball's radius for a ball.
    outlet
        ``"vented"`` if gas enters the diverging gap, which is then at ambient pressure;
        ``"flooded"`` if not, and the liquid sustains tension down to `cavity_pressure`.
    cavity_pressure
        Pressure [Pa] at which a flooded liquid ruptures, relative to ambient.
    thinning
        Decrease of the viscosity with the shear rate; None for a Newtonian liquid.

    Examples
    --------
    >>> Liquid("1.4 Pa s", outlet="flooded").lowest_pressure
    -100000.0
    """

    viscosity: float
    extent: float | None = None
    outlet: Outlet = "vented"
    cavity_pressure: float = VAPOUR
    thinning: ShearThinning | None = None

    def __post_init__(self) -> None:
        """Convert text to SI values and raise an error if one is impossible."""
        set_ = object.__setattr__
        set_(self, "viscosity", positive(self.viscosity, "Pa s", "viscosity"))
        if self.extent is not None:
            set_(self, "extent", to_si(self.extent, "m", name="inlet_length"))
        set_(self, "cavity_pressure", to_si(self.cavity_pressure, "Pa", name="cavity_pressure"))
        _require_known("outlet", self.outlet, Outlet)
        if not -np.inf < self.cavity_pressure < 0:
            raise AnalysisError(
                "cavity_pressure: a pressure below that outside is wanted, e.g. '-1 bar'; got "
                f"{self.cavity_pressure:g} Pa"
            )

    @property
    def lowest_pressure(self) -> float:
        """Lowest liquid pressure [Pa], in the cavity, relative to ambient."""
        return 0.0 if self.outlet == "vented" else self.cavity_pressure


@dataclass(frozen=True)
class Interface:
    """Interface of the bodies: shear stress of the real contact, rough body, adhesion and motion.

    Parameters
    ----------
    shear_stress
        sigma_f [Pa] in the real contact area.
    rough_body
        ``"stationary"`` or ``"moving"``, see `flow_factors`; None: from `factors`.
    roughness_balance
        (h2^2 - h1^2)/(h1^2 + h2^2) [1] of two rough bodies, 2 being the faster one: -1 if only the
        slower body is rough, 1 if only the faster one is. None: from `rough_body`.
    factors, separation
        Factors used instead of those of effective-medium theory, and p(u) instead of Persson's.
    work_of_adhesion
        Work of adhesion of the bodies in the liquid [J/m2]: adhesion then increases the contact
        area.
    slide_roll
        Slide-roll ratio SRR = (u2 - u1)/U [1] of two moving bodies, U = (u1 + u2)/2; None if one
        body is at rest (SRR = 2).
    abscissa
        Kind of speed in arguments and results if a slide-roll ratio is stated:
        ``"entrainment_speed"`` U, or ``"sliding_speed"`` SRR U, as in measured curves.

    Examples
    --------
    >>> Interface("1.2 MPa").shear_stress
    1200000.0
    """

    shear_stress: float = 0.0
    rough_body: RoughBody | None = None
    roughness_balance: float | None = None
    factors: FlowFactors | None = None
    separation: Separation | None = None
    work_of_adhesion: float | None = None
    slide_roll: float | None = None
    abscissa: Abscissa = "entrainment_speed"

    def __post_init__(self) -> None:
        """Convert text to SI values and raise an error if one is impossible."""
        stress = to_si(self.shear_stress, "Pa", name="shear_stress")
        object.__setattr__(self, "shear_stress", stress)
        if not 0 <= stress < np.inf:
            raise AnalysisError(
                f"shear_stress: it must be finite and not negative; got {stress:g} Pa"
            )
        for name, end in (("roughness_balance", 1.0), ("slide_roll", 2.0)):
            value = getattr(self, name)
            if value is None:
                continue
            value = to_si(value, "1", name=name)
            object.__setattr__(self, name, value)
            if not -end <= value <= end:
                raise AnalysisError(f"{name}: {-end:g} to {end:g} is possible; got {value:g}")
        _require_known("abscissa", self.abscissa, Abscissa)
        if self.slide_roll == 0 and self.abscissa == "sliding_speed":
            raise AnalysisError(
                "slide_roll: nothing slides in pure rolling; state another abscissa"
            )

    @property
    def entrained(self) -> float:
        """Ratio [1] of twice the entrainment speed to the speed used in arguments."""
        if self.slide_roll is None:
            return 1.0
        return 2.0 if self.abscissa == "entrainment_speed" else 2 / abs(self.slide_roll)


@dataclass(frozen=True)
class Solver:
    """Numerical parameters: resolution, theories and methods.

    Parameters
    ----------
    cells
        Cells across a line contact; a point contact has three eighths as many rings.
    domain
        Length of a line contact's domain relative to the default.
    gamma
        Elastic-energy reduction factor [1] of the mean separation.
    area
        Theory of the contact area, see `contact_area_ratio`.
    friction_factors
        False sets phi_f = phi_fp = 1 and phi_fs = 0 in the friction, but not in the flow.
    method
        For a ball: ``"full"`` theory on rings and sectors, ``"strips"`` (reduced, within 8 %
        for films thinner than 0.025 a^2/R), or ``"auto"``: strips within that limit and the full
        theory beyond, as in fits and bands.

    Examples
    --------
    >>> Solver(cells=240).cells
    240
    """

    cells: int = 160
    domain: float = 1.0
    gamma: float = 0.45
    area: AreaTheory = "persson"
    friction_factors: bool = True
    method: Method = "full"

    def __post_init__(self) -> None:
        """Raise an error if a value is impossible."""
        check_area(self.area)
        _require_known("method", self.method, Method)
        if self.cells < 50:
            raise AnalysisError(f"cells: at least 50 are wanted; got {self.cells}")
        if not 0.2 <= self.domain <= 5:
            raise AnalysisError(
                f"domain: a length between 0.2 and 5 is wanted; got {self.domain:g}"
            )


class Parameters(NamedTuple):
    """Parameters of a lubricated contact, except geometry, roughness, load and speed."""

    liquid: Liquid
    interface: Interface = Interface()
    solver: Solver = Solver()


_RENAMED = {"inlet_length": "extent"}
_PARTS = {"liquid": Liquid, "interface": Interface, "solver": Solver}
_HOME = {field.name: part for part, kind in _PARTS.items() for field in fields(kind)}


def parameters_of(
    liquid: Liquid | str | float,
    interface: Interface | str | float = 0.0,
    solver: Solver | None = None,
    **options: Any,
) -> Parameters:
    """Return liquid, interface and solver as one object, from objects or single values.

    Parameters
    ----------
    liquid, interface
        The objects, or only viscosity [Pa s] and shear stress [Pa].
    solver
        None: the default.
    **options
        Single fields of the three objects by name; ``inlet_length`` means `extent`.

    Examples
    --------
    >>> parameters_of("1.4 Pa s", "1 MPa", cells=60, inlet_length="20 mm").solver.cells
    60
    """
    parts: dict[str, Any] = {
        "liquid": liquid if isinstance(liquid, Liquid) else Liquid(liquid),  # type: ignore[arg-type]
        "interface": interface if isinstance(interface, Interface) else Interface(interface),  # type: ignore[arg-type]
        "solver": solver or Solver(),
    }
    for name, value in options.items():
        field = _RENAMED.get(name, name)
        if field not in _HOME:
            known = [*_HOME, *_RENAMED]
            raise AnalysisError(f"'{shown(name)}' is no parameter{nearest(name, known)}")
        if name == "inlet_length" and value is not None:
            value = to_si(value, "m", name="inlet_length")
        home = _HOME[field]
        parts[home] = replace(parts[home], **{field: value})
    return Parameters(**parts)


def as_stated(value: Any) -> Any:
    """Return a value as given by the user; an array without dims becomes a number."""
    return value if isinstance(value, Liquid | Interface) else stated_value(value)


def renamed(**names: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Return a decorator for functions that also accept argument names of the last release."""

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        @functools.wraps(function)
        def with_old(*args: Any, **kwargs: Any) -> R:
            return function(*args, **{names.get(name, name): kwargs[name] for name in kwargs})

        return with_old

    return decorate


def warn_of_old(function: str, options: Mapping[str, Any]) -> None:
    """Warn that arguments of the last release are now fields of an object."""
    if not options:
        return
    homes = sorted({_HOME[_RENAMED.get(n, n)] for n in options if _RENAMED.get(n, n) in _HOME})
    objects = " and ".join(_PARTS[home].__name__ for home in homes)
    warnings.warn(
        f"{function}: {', '.join(options)} will no longer be arguments after the next release; "
        f"give them to {objects or 'Solver'}, see tribolab.lubrication.parameters",
        FutureWarning,
        stacklevel=4,
    )
