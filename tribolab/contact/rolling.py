"""Rolling friction due to hysteresis in the bulk of the bodies."""

from __future__ import annotations

import numpy as np

from tribolab.contact.geometry import Contact
from tribolab.contact.hertz import hertz_half_width


def rolling_friction(
    load: str | float, contact: Contact, loss_share: float, counter_loss_share: float = 0.0
) -> float:
    """Return the rolling friction coefficient [1] of a contact with viscoelastic bodies.

    Parameters
    ----------
    load
        F_N/L [N/m], for a ball F_N [N].
    contact
        Geometry and elasticity.
    loss_share, counter_loss_share
        Share alpha [1] of the elastic energy that the flat and the counter body dissipate per cycle
        at the frequency U/a.

    Notes
    -----
    ``sum alpha_i s_i 3 a/(16 R)`` for a ball, with ``2 a/(3 pi R)`` instead of 3 a/(16 R) for a
    line contact; s_i is a body's share of the compliance [1]_.

    References
    ----------
    .. [1] J. A. Greenwood, H. Minshall, D. Tabor, Proc. R. Soc. A 259, 480 (1961).
       doi:10.1098/rspa.1961.0004

    Examples
    --------
    >>> from tribolab.contact.geometry import PointContact
    >>> ball = PointContact("9.5 mm", "1 MPa", 0.5)
    >>> f"{rolling_friction('3 N', ball, 0.2):.4f}"
    '0.0100'
    """
    share = contact.compliance_share
    lost = loss_share * share + counter_loss_share * (1 - share)
    factor = 3 / 16 if contact.is_round else 2 / (3 * np.pi)
    return float(lost * factor * hertz_half_width(load, contact) / contact.radius)
