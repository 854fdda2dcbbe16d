"""Line contacts in a Newtonian liquid on a half-space stay what they were to 1e-9."""

import json

import line_contact_numbers
import pytest


def test_line_contacts_are_unchanged() -> None:
    stored = json.loads(line_contact_numbers.STORED.read_text())
    for name, parts in line_contact_numbers.computed().items():
        for part, values in parts.items():
            # films agree to what Newton's method is converged to, 1e-9 of the pressure
            assert values == pytest.approx(stored[name][part], rel=1e-9, abs=1e-15), (name, part)
