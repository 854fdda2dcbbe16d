"""Errors in the calibration and mounting of a force cell: gain, tilt, cross-talk, hysteresis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Calibration:
    """True errors in the calibration and mounting of a force cell; all are zero by default.

    Parameters
    ----------
    friction_gain, normal_gain
        Relative errors of the gains.
    tilt
        Angle between cell and contact in the plane of sliding [rad], common to both axes.
    cross_talk_friction_from_normal, cross_talk_normal_from_friction
        Share of one force that appears in the reading of the other.
    friction_linearity
        Hysteresis of the friction channel [N], added to the force against the motion.
    normal_linearity
        Error of the normal force channel under load [N].

    Examples
    --------
    >>> tilted = Calibration(tilt=np.radians(2.0))
    >>> friction, normal = tilted.seen(np.array([14.0, -14.0]), np.array([10.0, 10.0]))
    >>> (friction / normal).round(4)
    array([ 1.5087, -1.3015])
    """

    friction_gain: float = 0.0
    normal_gain: float = 0.0
    tilt: float = 0.0
    cross_talk_friction_from_normal: float = 0.0
    cross_talk_normal_from_friction: float = 0.0
    friction_linearity: float = 0.0
    normal_linearity: float = 0.0

    def seen(self, friction: np.ndarray, normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the readings of both channels [N] for given true forces, without zero offsets.

        Parameters
        ----------
        friction
            Signed friction force [N].
        normal
            Normal force [N].
        """
        cos, sin = np.cos(self.tilt), np.sin(self.tilt)
        along = friction * cos + normal * sin + self.cross_talk_friction_from_normal * normal
        along = along + self.friction_linearity * np.sign(friction)
        across = normal * cos - friction * sin + self.cross_talk_normal_from_friction * friction
        across = across + self.normal_linearity * (normal > 0)
        return (1 + self.friction_gain) * along, (1 + self.normal_gain) * across
