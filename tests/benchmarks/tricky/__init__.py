"""Other labs' worlds: legal but tricky runs with known truth, without the project's own rig."""

from tricky import (  # noqa: F401 - the kinds register themselves
    kinds_clocks,
    kinds_oscillation,
    kinds_reading,
    kinds_segments,
    kinds_small,
    kinds_sound,
    kinds_zero,
)
from tricky.trial import SOUND, TRICKY

KINDS = TRICKY | SOUND
__all__ = ["KINDS", "SOUND", "TRICKY"]
