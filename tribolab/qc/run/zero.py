"""Checks on the zero of the friction force: its reference, and loss of the sign."""

from __future__ import annotations

from collections.abc import Mapping

from tribolab.core.attributes import SegmentAttributes
from tribolab.friction.zero.parts import Doubt
from tribolab.qc.register import Check, Result
from tribolab.qc.run.subject import RunSubject


def _zero_reference(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    friction = subject.friction
    signal = subject.required_friction_signal
    doubts = _doubts(subject, "zero_reference", signal)
    method = SegmentAttributes.from_attrs(friction.attrs).offset
    return doubts or [Result("pass", signal, f"the zero is from: {method}")]


def _rectified_signal(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    signal = subject.required_friction_signal
    doubts = _doubts(subject, "rectified", signal)
    return doubts or [Result("pass", signal, "no indication that the signal lost its sign")]


def _doubts(subject: RunSubject, check: str, signal: str) -> list[Result]:
    """Return a result for each doubt about the zero, without flags on samples."""
    doubts: list[Doubt] = SegmentAttributes.from_attrs(subject.friction.attrs).zero_doubts
    results = []
    for doubt in doubts:
        if doubt["check"] != check:
            continue
        which = [int(i) for i in doubt["segments"]]
        where = subject.segment_label(which[0]) if 0 < len(which) < len(subject.slices) else ""
        results.append(
            Result(
                doubt["status"],
                signal,
                doubt["message"],
                where=where,
                count=len(which) if doubt["status"] == "suspect" else 0,
                noted=bool(doubt.get("noted")),
                cure=doubt["cure"],
            )
        )
    return results


ZERO_CHECKS = (
    Check(
        "zero_reference",
        29,
        "Is the zero of the friction force known, and do all its sources agree?",
        "Record strokes in both directions, or a rest without load; or state "
        "`zero_uncertainty` in campaign.toml.",
        {},
        _zero_reference,
    ),
    Check(
        "rectified",
        30,
        "Was the friction force recorded with its sign?",
        "State `rectified` for the column, in the instrument's file.",
        {},
        _rectified_signal,
    ),
)
