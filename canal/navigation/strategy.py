"""Where the legs of a travel end, and which ratio their strategy gives (paper IV-C, V-E)."""

import math

from canal.navigation.options import NavigationOptions
from canal.navigation.state import Leg, NavigationState
from canal.surface import CanalSurface


def phase(canal: CanalSurface, disk: float) -> float:
    """The paper's d in [-1, 1]: -1 pick, 0 home, +1 place (V-E).

    Args:
        canal: that is travelled.
        disk: continuous index.
    """
    home = canal.home_disk
    return (disk - home) / (home if disk < home else canal.n_disks - 1 - home)


def leg_end(canal: CanalSurface, leg: Leg) -> float:
    """Disk at which a leg ends.

    Args:
        canal: that is travelled.
        leg: of the cycle.
    """
    if leg.homeward:
        return float(canal.home_disk)
    return 0.0 if leg is Leg.HOME_TO_PICK else float(canal.n_disks - 1)


def strategy_ratio(canal: CanalSurface, state: NavigationState, disk: float, options: NavigationOptions) -> float:
    """Ratio η that the leg's strategy gives at `disk`: fixed outwards, decaying towards home (paper IV-C).

    The decay is slower where it would else take away more than a metre in a metre of travel: on what is left of a leg
    after a reversal or a correction close to home. Then a part of η is left at home, and the next leg keeps it.

    Args:
        canal: that is travelled.
        state: has the leg, and where its strategy began.
        disk: continuous index, ahead of that.
        options: of the travel.
    """
    leg = Leg(int(state.leg))
    if not leg.homeward:
        return state.anchor_eta
    travelled = abs(disk - state.anchor_disk)
    # What the whole decay takes away, in disks of travel.
    least = abs(state.anchor_eta - options.eta_f) * canal.widest_homewards(state.anchor_disk)
    if options.decay == "paper":
        rate = options.decay_lambda
        decay = math.exp(-(rate if rate * least <= 1 else 1 / least) * travelled)
    else:
        # The steepest slope of exp(-a u²) is √(2a/e).
        whole = max(abs(leg_end(canal, leg) - state.anchor_disk), math.sqrt(2 * options.decay_a / math.e) * least)
        u = min(travelled / whole, 1.0) if whole > 0 else 1.0
        decay = math.exp(-options.decay_a * u * u)
    return options.eta_f + (state.anchor_eta - options.eta_f) * decay
