"""Type aliases used in many signatures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
PathLike = str | Path
