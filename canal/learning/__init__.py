"""From demonstrations to a canal (paper IV-A, IV-B, V-A).

Pauses are trimmed, demonstrations aligned, curves fitted, and disks with their frames laid along the mean.
`learn_canal` runs the whole; the other modules are its steps.
"""

from canal.learning.learn import build_surface, learn_canal

__all__ = ["build_surface", "learn_canal"]
