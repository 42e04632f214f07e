"""What is taught: the path of the tool as a demonstration, and the way back along it."""

from __future__ import annotations

import enum
from dataclasses import dataclass, replace

import numpy as np

from canal.demonstration import MIN_SAMPLES, SAMPLE_RATE_HZ, Demonstration
from diagrams.teach.jog import off

MOVED, TURNED = 2e-4, 2e-3
"""[m], [rad] Since the last sample: less is standing still, which takes no time of a demonstration."""
NEAR, NEAR_TURN = 0.010, 0.10
"""[m], [rad] From the tool to the sample it is led back to, for the next one to come: two samples at full speed."""
UNDO_S = 2.0
"""[s] Of motion that one Undo takes back."""
PATIENCE = 40
"""Samples near the end of the way back after which it ends: what was recorded while the tool pressed on a table is not
reached again to the millimetre."""
MOST = 12_000
"""Samples that are kept: ten minutes of motion, 60 m."""


class Word(enum.IntEnum):
    """What a person says to the recorder."""

    NOTHING = 0
    RECORD = 1
    """Record, or go on from where the recording paused."""
    PAUSE = 2
    UNDO = 3
    """Go back along the path by `UNDO_S`, and forget it."""
    BACK = 4
    """Go back to where the path began."""
    STAND = 5
    """Go back no further."""


@dataclass(frozen=True, eq=False)
class TaughtPath:
    """Where the tool was, and what of it is the demonstration.

    Attributes:
        poses: of the tool in the base frame at 20 Hz of motion: the demonstration, then what was moved since without
            recording. Shape (N, 7).
        kept: how many of them are the demonstration.
        recording: whether what is moved now is.
        back_to: how many samples are left when the way back ends; -1 while there is none.
        then_record: whether it records from there on.
        waited: how many samples long the tool has been near the end of the way back.
    """

    poses: np.ndarray
    kept: int = 0
    recording: bool = False
    back_to: int = -1
    then_record: bool = False
    waited: int = 0

    @property
    def leads_back(self) -> bool:
        """Whether the tool is led back along its path."""
        return self.back_to >= 0

    @property
    def enough(self) -> bool:
        """Whether it can be a demonstration."""
        return self.kept >= MIN_SAMPLES

    @property
    def duration_s(self) -> float:
        """Of the demonstration, [s] of motion."""
        return self.kept / SAMPLE_RATE_HZ

    def demonstration(self, name: str) -> Demonstration:
        """What was recorded.

        Args:
            name: for messages.

        Raises:
            InputError: it is too short.
        """
        poses = self.poses[: self.kept]
        return Demonstration(poses[:, :3], poses[:, 3:], name=name)

    def forgotten(self) -> TaughtPath:
        """With no demonstration any more; the way back stays."""
        return replace(self, kept=0, recording=False, back_to=-1, then_record=False)

    def told(self, word: Word, *, pushed: bool) -> TaughtPath:
        """What becomes of it at a word.

        Args:
            word: said now.
            pushed: whether the hand moves the tool: that ends the way back.
        """
        path = self if word is Word.NOTHING else replace(self, waited=0)
        if word is Word.STAND or (pushed and path.leads_back):
            path = replace(path, back_to=-1, then_record=False)
        if word is Word.RECORD and not path.recording:
            if not path.kept:  # it begins here
                return replace(path, poses=path.poses[:0], recording=True, back_to=-1)
            if path.kept < len(path.poses):
                return replace(path, back_to=path.kept, then_record=True)
            return replace(path, recording=True)
        if word is Word.PAUSE:
            return replace(path, recording=False, back_to=-1, then_record=False)
        if word in (Word.UNDO, Word.BACK):
            end = path.back_to if path.leads_back else len(path.poses)
            most = end if word is Word.BACK else round(UNDO_S * SAMPLE_RATE_HZ)
            return replace(
                path, back_to=max(end - most, 0), then_record=path.recording or path.then_record, recording=False
            )
        return path

    def moved(self, pose: np.ndarray) -> TaughtPath:
        """One sample later.

        Args:
            pose: of the tool, as measured. Shape (7,).
        """
        if self.leads_back:
            return self._back(pose)
        if len(self.poses):
            far, turned = off(pose, self.poses[-1])
            if far < MOVED and turned < TURNED:
                return self
        if len(self.poses) >= MOST:
            if self.kept:
                return replace(self, recording=False)
            return replace(self, poses=np.vstack([self.poses[MOST // 2 :], pose]))
        poses = np.vstack([self.poses, pose])
        return replace(self, poses=poses, kept=len(poses) if self.recording else self.kept)

    def _back(self, pose: np.ndarray) -> TaughtPath:
        left = len(self.poses)
        far, turned = off(pose, self.poses[-1]) if left else (0.0, 0.0)
        away = max(far / NEAR, turned / NEAR_TURN)
        if away > 1.0:
            return self  # the tool is still on its way to this one
        if left > max(self.back_to, 1):
            left -= 1
            return replace(self, poses=self.poses[:left], kept=min(self.kept, left))
        if away > 0.25 and self.waited < PATIENCE:
            return replace(self, waited=self.waited + 1)
        return replace(self, back_to=-1, recording=self.then_record, then_record=False)
