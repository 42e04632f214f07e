"""The console of one run: its server, who steers, and what the run tells it."""

from __future__ import annotations

import os
import sys
import threading
import time
import webbrowser
from collections.abc import Callable
from typing import Any

from pydrake.geometry import Meshcat
from pydrake.math import RollPitchYaw
from pydrake.systems.framework import Context

from canal.navigation.joystick import JOYSTICK_PERIOD
from canal.surface import CanalSurface
from diagrams.announcements import Announcement
from diagrams.scenario import Scenario
from diagrams.scene.world import World
from diagrams.shared_autonomy import SharedAutonomy
from diagrams.station.lio_station import LioStation
from diagrams.view.gripper_camera import GripperCamera, can_render
from geosacs_drake.console.control import Control
from geosacs_drake.console.link import Answers
from geosacs_drake.console.mapping_choice import MappingChoice, chosen_view
from geosacs_drake.console.server import ConsoleServer
from geosacs_drake.console.status import StatusReporter
from geosacs_drake.process.run_again import earlier_address

WAIT_FOR_PAGE_S = 15.0
"""[s] With no page after so long the simulated operator begins."""
ALONE_S = 5.0
"""[s] After the end, with no page for so long nobody will say that it is to run again."""
LOOK_S = 0.05
"""[s] Between two looks whether somebody has begun."""


class Console:
    """What a run holds of its console."""

    def __init__(self, meshcat: Meshcat, *, person: bool, host: str = "localhost", port: int | None = None) -> None:
        """Serve a console with `meshcat` in its page.

        Args:
            meshcat: shows the robot.
            person: whether a person was asked for, without whom the run does not begin.
            host: the address to listen at.
            port: see `ConsoleServer`.

        Raises:
            InputError: the port is taken.
        """
        address = meshcat.web_url().removeprefix("http://").partition(":")
        earlier = earlier_address()
        self._again = earlier is not None
        self._word = threading.Event()
        self.control = Control(person_asked=person)
        self.answers = Answers()
        self.server = ConsoleServer(
            self.control,
            self.answers,
            meshcat_address=(address[0], int(address[2])),
            host=host,
            port=port if earlier is None else earlier[0],
            token=None if earlier is None else earlier[1],
        )
        self.answers.on_word = self._hear
        self._person = person
        self._standing = ""
        self._said = ""
        self._report: Callable[[Context], None] = lambda root: None
        self._camera: GripperCamera | None = None
        self._mapping, self._seat = "axes", "front"
        self.server.start()

    @property
    def address(self) -> str:
        """Of the page."""
        return self.server.address

    def open_browser(self) -> None:
        """Open the page where there is a display and a terminal to close it from."""
        if not self._again:
            open_page(self.address)

    def say(self, announcement: Announcement) -> None:
        """What a person is told goes to the history."""
        self.server.tell(
            {"time_s": round(announcement.time_s, 1), "kind": str(announcement.event), "text": announcement.text}
        )

    def show_standing(self, before: str, text: str, time_s: float) -> None:
        """What holds from now on.

        Args:
            before: what held until now.
            text: what holds; empty for nothing.
            time_s: when, [s].
        """
        self._standing = text

    def standing(self) -> str:
        """What holds now."""
        return self._standing

    def choose_mapping(self, canal: CanalSurface, mapping: str, seat: str) -> MappingChoice:
        """Begin with a mapping of the stick; pages may choose another.

        Args:
            canal: that is travelled.
            mapping: at the start: axes, seat or view.
            seat: where the person sits at the start.
        """
        self._mapping, self._seat = mapping, seat
        self.answers.mapping = MappingChoice(canal, chosen_view(mapping, seat))
        return self.answers.mapping

    def report(self, system: SharedAutonomy, canal: CanalSurface, scenario: Scenario) -> None:
        """Tell the pages of a run, at each `look`.

        Args:
            system: the run's diagram.
            canal: that is travelled.
            scenario: of the run.
        """
        navigation = scenario.navigation
        self.answers.full_stick_mm = 1000 * 20.0 / navigation.delta * JOYSTICK_PERIOD
        about = {
            "task": scenario.task,
            "description": scenario.description or scenario.task,
            "full_stick_mm": self.answers.full_stick_mm,
            "disks": canal.n_disks,
            "mapping": self._mapping,
            "seat": self._seat,
            "base_yaw": float(RollPitchYaw(system.station.X_WB.rotation()).yaw_angle()),
            "base": system.station.X_WB.translation(),
            "bindings": self.answers.bindings.all(),
        }
        self.server.introduce(about)
        self._report = StatusReporter(
            system=system,
            canal=canal,
            item_names=[item.name for item in scenario.items],
            control=self.control,
            show=self.server.show,
            standing=self.standing,
        )

    def show_gripper(self, station: LioStation, world: World, seed: int) -> None:
        """Let pages look through the gripper's camera, where this machine renders pictures.

        Args:
            station: of the run.
            world: that it was built from.
            seed: likewise.
        """
        self.answers.shows_pictures = can_render()
        if self.answers.shows_pictures:
            self._camera = GripperCamera(station, world, seed, self.server)

    def look(self, root: Context) -> None:
        """Tell the pages how the run stands; called after each step of it.

        Args:
            root: the diagram's context.
        """
        self._report(root)
        if self._camera is not None:
            self._camera.look(root)

    def wait(self, root: Context, asked_to_end: Callable[[], bool]) -> None:
        """Wait until somebody says Start or Watch, or nobody is there to say it.

        Args:
            root: the diagram's context.
            asked_to_end: whether the run is to end.
        """
        begin = time.monotonic()
        while not self.control.wait_for_beginning(LOOK_S) and not asked_to_end():
            if self._camera is not None:
                self._camera.look(root)
            waited = time.monotonic() - begin
            if not self._person and not self.server.pages and waited > WAIT_FOR_PAGE_S:
                self.control.watch()

    def end(self, summary: dict[str, Any]) -> None:
        """Show what was achieved."""
        self.server.show_end(summary | {"again": self.offers_again})

    @property
    def offers_again(self) -> bool:
        """Whether somebody may want to run again: a page is open, and a terminal to end it from."""
        return sys.stdout.isatty() and self.server.pages > 0

    def wait_for_again(self, asked_to_end: Callable[[], bool]) -> bool:
        """Wait while a page is open for somebody to say what comes next; whether it is to run again."""
        print("run again in the page, or end it with Ctrl-C", flush=True)
        alone_since = time.monotonic()
        while not self._word.wait(LOOK_S) and not asked_to_end():
            if self.server.pages:
                alone_since = time.monotonic()
            elif time.monotonic() - alone_since > ALONE_S:
                return False
        return self._said == "again"

    def _hear(self, page: str, word: str) -> str:
        if word in ("again", "leave"):
            self._said = word
            self._word.set()
        return ""

    def close(self) -> None:
        """Let go of the pages and the port."""
        self.server.stop()


def open_page(address: str) -> None:
    """Open a page in a browser where there is a display, and a terminal to end the command from.

    Args:
        address: of the page.
    """
    display = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY") or sys.platform in ("darwin", "win32")
    if display and sys.stdout.isatty():
        webbrowser.open(address)
