"""Tables that the arm of a test can press on."""

from diagrams.scenario import Scenario


def high_table(scenario: Scenario) -> None:
    """Put laundry's table under the hand of the start posture; only one item stays, aside."""
    scenario.fixtures[1].position = [0.36, 0.0, 0.68]
    scenario.fixtures = [scenario.fixtures[0], scenario.fixtures[1], scenario.fixtures[3]]
    del scenario.items[1:]
    scenario.items[0].start.center = [0.50, 0.25, 0.98]
