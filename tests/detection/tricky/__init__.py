"""Other labs' worlds: legal but tricky runs with known truth, without the project's own rig."""

from tricky import (  # noqa: F401 - the kinds register themselves
    kinds_clocks,
    kinds_load,
    kinds_oscillation,
    kinds_reading,
    kinds_segments,
    kinds_small,
    kinds_sound,
    kinds_zero,
)
from tricky.trial import SOUND, TRICKY

KINDS = TRICKY | SOUND
_NEW = (kinds_load.__name__, kinds_small.__name__)
NEW = [name for name, kind in TRICKY.items() if kind.make.__module__ in _NEW]
__all__ = ["KINDS", "NEW", "SOUND", "TRICKY"]
