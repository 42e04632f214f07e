"""What a person sees before they take an item: which others the hand would meet on its way, and has to take first."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from canal.surface import CanalSurface
from diagrams.scene.layout import in_the_way
from diagrams.scene.way_down import room_at


class Ways:
    """The ways down to both ends of a canal."""

    def __init__(self, canal: CanalSurface, precise: Sequence[bool]) -> None:
        """`precise` says of each item whether it belongs on a mark: what may lie anywhere is not waited for."""
        self._precise = precise
        self._middles = canal.directrix[0, :2], canal.directrix[-1, :2]
        self._rooms = [room_at(canal, end) for end in (0, canal.n_disks - 1)] if any(precise) else []

    def waits_for(self, item: int, todo: Sequence[int], positions: np.ndarray, p_BG: np.ndarray) -> int:
        """How many should be carried before an item, of those that are still to do.

        Args:
            item: index of the item.
            todo: indices of all that are still to do.
            positions: where items are, in B [m]. Shape (n, 3).
            p_BG: where they belong, in B [m]. Shape (n, 3).
        """
        if not self._precise[item]:
            return 0
        (pick, place), (at_pick, at_place) = self._rooms, self._middles
        starts, marks = positions[:, :2] - at_pick, p_BG[:, :2] - at_place
        return sum(
            in_the_way(pick, starts[item], starts[other]) + in_the_way(place, marks[other], marks[item])
            for other in todo
            if other != item and self._precise[other]
        )
