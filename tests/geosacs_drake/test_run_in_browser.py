"""A run as a person sees it: its page in a browser, a key that is heard, and Ctrl-C while the browser looks on."""

import json
import signal

import numpy as np
import pytest
from running import running
from waiting import wait_until

COLORS = """() => {
    viewer.render();
    const gl = viewer.renderer.getContext(), w = gl.drawingBufferWidth, h = gl.drawingBufferHeight;
    const pixels = new Uint8Array(4 * w * h);
    gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    const colors = new Set();
    for (let k = 0; k < pixels.length; k += 4)
        colors.add((pixels[k] >> 4) << 8 | (pixels[k + 1] >> 4) << 4 | pixels[k + 2] >> 4);
    return [...colors];
}"""


@pytest.mark.browser
def test_the_task_is_seen_a_key_is_heard_and_it_leaves_in_good_order(page, tmp_path):
    log, summary = tmp_path / "log.npz", tmp_path / "summary.json"
    files = ("--log", str(log), "--summary", str(summary))
    arguments = ("--operator", "keyboard", "--items", "rigid", *files, "--no-console", "--port", "0")
    with running("geosacs_drake.run_laundry", *arguments) as command:
        page.goto(command.address())
        children = "Object.keys(viewer.scene_tree.find(['drake']).children)"
        wait_until(lambda: {"canal", "trail"} <= set(page.evaluate(children)), "the canal", 120)
        wait_until(lambda: len(page.evaluate(COLORS)) > 50, "a picture with robot, machine and canal", 120)
        heard = "Object.keys(viewer.keydown_callbacks)"
        wait_until(lambda: {"KeyG", "Space"} <= set(page.evaluate(heard)), "the controls", 60)
        page.keyboard.press("Space")
        page.wait_for_timeout(3000)
        command.process.send_signal(signal.SIGINT)
        # The page stays open: leaving must not wait for it.
        wait_until(lambda: command.process.poll() is not None, "the command to leave", 60)
        assert command.process.returncode == 1, command.output
    assert json.loads(summary.read_text())["success"] is False
    with np.load(log) as signals:
        pressed = np.flatnonzero(signals["buttons"][:, 3])
        assert pressed.size
        # A person was asked for: nothing but the one key, from the beginning.
        assert not signals["stick"].any()
        assert not signals["buttons"][:, :3].any()
