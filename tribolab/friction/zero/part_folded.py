"""Friction force that lost its sign, or whose zero jumped, in a part of the run."""

from __future__ import annotations

import numpy as np

from tribolab.arrays.medians import median
from tribolab.friction.zero import limits
from tribolab.friction.zero.parts import Doubt, StrokeMeans, doubt


def of_parts(strokes: StrokeMeans) -> tuple[Doubt, ...]:
    """Return doubts about pairs with one sign in both directions, if other pairs change sign.

    Half the difference of such a pair is not friction: equal levels mu N give zero.

    Parameters
    ----------
    strokes
        Means of the segments and their pairs.
    """
    pairs = np.arange(strokes.pair.max(initial=-1) + 1)
    if not pairs.size:
        return ()
    members = np.array([np.flatnonzero(strokes.pair == p)[:2] for p in pairs])
    mean, error = strokes.mean[members], np.nan_to_num(strokes.error[members])
    middle, half = mean.mean(axis=1), np.abs(np.diff(mean, axis=1)[:, 0]) / 2
    size = np.abs(mean)
    signed = (np.prod(mean, axis=1) < 0) & (
        np.abs(middle) < limits.MAX_MIDDLE_OF_SIGNED_LOOP.value * half
    )
    clear = (size > limits.MIN_ERRORS_OF_LEVEL.value * error).all(axis=1)
    alike = size.min(axis=1) > limits.MIN_LEVEL_RATIO_OF_LOST_SIGN.value * size.max(axis=1)
    one_sign = (np.prod(mean, axis=1) > 0) & clear & alike
    if not signed.any() or not one_sign.any():
        return ()
    usual = float(median(half[signed]))
    one_sign &= (np.abs(middle) > usual / limits.MAX_FRICTION_RATIO_OF_PARTS.value) & (
        np.abs(middle) < usual * limits.MAX_FRICTION_RATIO_OF_PARTS.value
    )
    if not one_sign.any():
        return ()
    named = ", ".join("-".join(str(strokes.number[i]) for i in pair) for pair in members[one_sign])
    text = (
        f"friction has one sign both ways in segments {named}, and changes it with the direction "
        f"in others: its sign was lost there, or its zero moved by about "
        f"{median(np.abs(middle[one_sign])):.3g}{strokes.unit}"
    )
    cure = (
        "Look at the trace: reject the part where the signal changed, or part the run there and "
        "state `rectified` of each."
    )
    remark = doubt(text, cure, members[one_sign].ravel())
    remark["check"] = "rectified"
    return (remark,)
