"""A Chromium of our own, spoken to by its debugging protocol alone: a page there can be hidden, frozen or stopped.

Playwright keeps each of its pages visible and focused, whatever else happens to it.
"""

from __future__ import annotations

import asyncio
import itertools
import json
import os
import shutil
import signal
import subprocess
import tempfile
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from typing import Any

from tornado.websocket import WebSocketClientConnection, websocket_connect

ARGS = ("--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--ignore-gpu-blocklist")
"""What makes Debian's Chromium draw WebGL without a display or a graphics card."""
ARROW_RIGHT = {"key": "ArrowRight", "code": "ArrowRight", "windowsVirtualKeyCode": 39}


class OwnBrowser:
    """A headless Chromium with one page."""

    def __init__(self, process: subprocess.Popen[bytes], connection: WebSocketClientConnection) -> None:
        self._process, self._connection = process, connection
        self._numbers = itertools.count(1)
        self.session = ""
        self.target = ""

    async def call(self, method: str, *, of_page: bool = True, **parameters: Any) -> dict[str, Any]:
        """Call a method of the protocol and wait for what it answers.

        Args:
            method: its name.
            of_page: whether it is told to the page, and not to the browser.
            parameters: as the protocol names them.

        Raises:
            RuntimeError: the method failed.
        """
        number = next(self._numbers)
        message: dict[str, Any] = {"id": number, "method": method, "params": parameters}
        if of_page:
            message["sessionId"] = self.session
        await self._connection.write_message(json.dumps(message))
        while text := await self._connection.read_message():
            answer = json.loads(text)
            if answer.get("id") == number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
        raise RuntimeError(f"{method}: the browser has gone")

    async def open(self, address: str) -> None:
        """Show a page."""
        self.target = (await self.call("Target.createTarget", of_page=False, url=address))["targetId"]
        attached = await self.call("Target.attachToTarget", of_page=False, targetId=self.target, flatten=True)
        self.session = attached["sessionId"]

    async def evaluate(self, script: str) -> Any:
        """What a script in the page comes to, a promise what it holds."""
        answer = await self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        return answer["result"].get("value")

    async def hold_right(self) -> None:
        """Press the right arrow, and keep it down."""
        await self.call("Input.dispatchKeyEvent", type="rawKeyDown", **ARROW_RIGHT)

    async def let_go(self) -> None:
        """Release it."""
        await self.call("Input.dispatchKeyEvent", type="keyUp", **ARROW_RIGHT)

    # ---- what becomes of a page ----

    async def hide(self) -> None:
        """Show another tab."""
        await self.call("Target.createTarget", of_page=False, url="about:blank")

    async def freeze(self) -> None:
        """Freeze the page, as a browser does to one that is out of sight."""
        await self.call("Page.setWebLifecycleState", state="frozen")

    async def stop(self) -> None:
        """Stop all processes of the browser, as a machine does that goes to sleep."""
        os.killpg(self._process.pid, signal.SIGSTOP)

    async def go_on(self) -> None:
        """Let them go on."""
        os.killpg(self._process.pid, signal.SIGCONT)

    async def close_tab(self) -> None:
        """Close the page."""
        await self.call("Target.closeTarget", of_page=False, targetId=self.target)

    async def kill(self) -> None:
        """End all processes of the browser at once."""
        os.killpg(self._process.pid, signal.SIGKILL)


@asynccontextmanager
async def own_browser(path: str | None = None) -> AsyncIterator[OwnBrowser]:
    """A headless Chromium for an `async with` block.

    Args:
        path: of Chromium; None: the one that is installed.

    Yields:
        The browser.
    """
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        command = [
            path or shutil.which("chromium") or "chromium",
            "--headless=new",
            "--remote-debugging-port=0",
            f"--user-data-dir={profile}",
            "--no-first-run",
            "--window-size=1280,800",
            *ARGS,
        ]
        with subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
        ) as process:
            try:
                said = Path(profile) / "DevToolsActivePort"
                while not said.exists() or len(said.read_text().split()) < 2:
                    if process.poll() is not None:
                        raise RuntimeError(f"{command[0]} ended with status {process.returncode}")
                    await asyncio.sleep(0.02)
                port, place = said.read_text().split()
                connection = await websocket_connect(f"ws://127.0.0.1:{port}{place}", max_message_size=1 << 26)
                yield OwnBrowser(process, connection)
                connection.close()
            finally:
                with suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL)
