#!/usr/bin/env python3
"""scripts/demo: that it shows what it is to show, also on a slow machine; and what it says and leaves
behind when something fails.

ROIO_SOURCE is the source folder, ROIO_IMAGES has uno/*.elf, ROIO_SIM and ROIO_CLI are the programs."""

import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

SOURCE = pathlib.Path(os.environ["ROIO_SOURCE"])
GUARD = 300  # seconds; against hanging only


class DemoTest(unittest.TestCase):
    """A tree of its own, whose `cmake` builds nothing and whose programs are wrapped."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name in ("scripts", "path", "tmp", "build/bin", "build/release/firmware"):
            (self.folder / name).mkdir(parents=True)
        (self.folder / "bus").mkdir(mode=0o700)
        shutil.copy(SOURCE / "scripts/demo", self.folder / "scripts")
        (self.folder / "build/release/firmware/uno").symlink_to(os.environ["ROIO_IMAGES"] + "/uno")
        (self.folder / "examples").symlink_to(SOURCE / "examples")
        self.program("scripts/setup", "true")
        self.program("path/cmake", "true")
        self.program("build/bin/roio-sim", f'exec "{os.environ["ROIO_SIM"]}" "$@"')
        self.program("build/bin/roio-cli", f'exec "{os.environ["ROIO_CLI"]}" "$@"')
        self.env = dict(os.environ, PATH=f"{self.folder}/path:{os.environ['PATH']}",
                        TMPDIR=f"{self.folder}/tmp", ROIO_RUNTIME_DIR=f"{self.folder}/bus")

    def program(self, name, text):
        path = self.folder / name
        path.write_text(f"#!/bin/bash\n{text}\n")
        path.chmod(0o755)

    def start(self, *words):
        return subprocess.Popen([self.folder / "scripts/demo", *words], stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=self.env)

    def demo(self, *words):
        """Exit status, output, errors; nothing is left, neither files nor processes."""
        process = self.start(*words)
        out, err = process.communicate(timeout=GUARD)
        self.assert_nothing_left()
        return process.returncode, out, err

    def assert_nothing_left(self):
        self.assertEqual(os.listdir(self.folder / "tmp"), [])
        found = subprocess.run(["pgrep", "-f", f"{self.folder}/tmp"], capture_output=True, text=True)
        self.assertEqual(found.stdout, "")


class ShownTest(DemoTest):
    def check(self):
        status, out, err = self.demo()
        self.assertEqual((status, err), (0, ""), out)
        for line in ("pc      -> arm      normal  angles    shoulder=90 deg  elbow=45 deg  hand=180 deg",
                     "arm     -> pc       normal  refusals  count=1",
                     "arm: servo: pin 3 at 90 degrees"):
            self.assertIn(f"  {line}\n", out)
        self.assertNotRegex(out, r"(?m)^  \$ .*build/")
        self.assertNotIn("garbled", out)
        self.assertNotIn("lost:", out)

    def test_messages_and_servos(self):
        self.check()

    # A third of real time: a bridge's answers come later than a PC is used to, and are asked for again.
    def test_on_a_slow_machine(self):
        self.program("build/bin/roio-sim", f'exec "{os.environ["ROIO_SIM"]}" --speed 0.3 "$@"')
        self.check()

    def test_help_and_a_wrong_command_line(self):
        status, out, err = self.demo("--help")
        self.assertEqual((status, err), (0, ""))
        self.assertTrue(out.startswith("usage: scripts/demo\n"))
        self.assertEqual(self.demo("fast"), (2, "", "demo: expected no argument; got 'fast'\n"))


class FailureTest(DemoTest):
    def failure(self):
        """The line that says what failed, and all that was said."""
        status, _, err = self.demo()
        self.assertEqual(status, 1, err)
        self.assertNotIn("unbound variable", err)
        lines = [line for line in err.splitlines() if line.startswith("demo: ")]
        self.assertEqual(len(lines), 1, err)
        return lines[0], err

    def test_setup(self):
        self.program("scripts/setup", 'echo "setup: no root here" >&2; exit 1')
        self.assertEqual(self.demo(), (1, "", "setup: no root here\n"))

    def test_the_build(self):
        self.program("path/cmake", "echo a broken compiler; exit 1")
        line, err = self.failure()
        self.assertEqual(line, "demo: the build failed; all it said is in build/demo.log")
        self.assertIn("a broken compiler\n", err)

    def test_boards_that_do_not_start(self):
        self.program("build/bin/roio-sim", "echo 'no boards today' >&2; exit 1")
        line, err = self.failure()
        self.assertEqual(line, 'demo: no line "^usb: serial port: " came')
        self.assertIn("--- boards.errors\nno boards today\n", err)

    def test_a_bridge_that_does_not_answer(self):
        self.program("build/bin/roio-cli", "echo 'roio-cli: nobody there' >&2; exit 1")
        line, err = self.failure()
        self.assertEqual(line, "demo: the bridge does not answer")
        self.assertIn("--- bridge.errors\nroio-cli: nobody there\n", err)

    def test_a_bridge_that_goes_away(self):
        self.program("build/bin/roio-cli",
                     f'[ "$2" != attach ] || {{ echo "gone" >&2; exit 1; }}; exec "{os.environ["ROIO_CLI"]}" "$@"')
        line, err = self.failure()
        self.assertEqual(line, 'demo: no line ": attached to " came')
        self.assertIn("--- attached\ngone\n", err)

    def test_a_message_that_cannot_be_sent(self):
        self.program("build/bin/roio-cli",
                     f'[ "$1" != send ] || exit 1; exec "{os.environ["ROIO_CLI"]}" "$@"')
        line, _ = self.failure()
        self.assertEqual(line, "demo: it could not be sent")

    def test_boards_that_end_too_early(self):
        self.program("build/bin/roio-sim", f'exec "{os.environ["ROIO_SIM"]}" --for 0.05 --speed max "$@"')
        self.failure()

    def test_a_signal_in_the_middle(self):
        self.program("build/bin/roio-cli", f'touch "{self.folder}/asked"; exec sleep 60')
        process = self.start()
        deadline = time.monotonic() + GUARD
        while not (self.folder / "asked").exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        process.send_signal(signal.SIGTERM)
        subprocess.run(["pkill", "-P", str(process.pid), "timeout"], check=False)
        process.communicate(timeout=GUARD)
        self.assertEqual(process.returncode, 143)
        self.assert_nothing_left()


if __name__ == "__main__":
    unittest.main()
