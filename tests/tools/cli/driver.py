"""Runs roio-cli for the end-to-end tests: as a user would, through its command line and its streams.

ROIO_CLI names the program. Each test case has local buses of its own, in a folder of its own. Deadlines
are guards against hanging, nothing else. With ROIO_SLOW_CLOCK=N and ROIO_SLOW_CLOCK_LIBRARY, every
program that a test starts lives N times slower (tests/support/slow_clock.cpp); the test itself does not.
"""

import os
import re
import shutil
import subprocess
import tempfile
import threading
import time
import unittest

CLI = os.environ["ROIO_CLI"]
GUARD = 120  # seconds
SLOWER = 1
if "ROIO_SLOW_CLOCK_LIBRARY" in os.environ:
    SLOWER = int(os.environ["ROIO_SLOW_CLOCK"])
    os.environ["LD_PRELOAD"] = os.environ["ROIO_SLOW_CLOCK_LIBRARY"]
ON_SOCKETCAN = "ROIO_CLI_ON_SOCKETCAN" in os.environ  # real SocketCAN is there: in the lab


def masked(text):
    """The text with every time in it replaced, by as many digits as it had before its point."""
    text = re.sub(r"\((\d+)\.\d{6}\)", lambda m: "(" + "0" * len(m[1]) + ".000000)", text)
    return re.sub(r'"timestamp":\d+(\.\d+)?', '"timestamp":0', text)


def wait_until(condition):
    deadline = time.monotonic() + GUARD
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError("waited in vain")
        time.sleep(0.01)


def catches(process, number):
    """Whether a process has a handler for a signal."""
    with open(f"/proc/{process.pid}/status") as status:
        caught = int(re.search(r"SigCgt:\s*(\w+)", status.read())[1], 16)
    return bool(caught >> (number - 1) & 1)


class Dump:
    """A `roio-cli dump -v` that listens already. Its "listening" and its final count are checked here
    and taken out of what it says on standard error."""

    def __init__(self, *arguments, env=None, stdout=subprocess.PIPE, prefix=()):
        self.process = subprocess.Popen(
            [*prefix, CLI, "dump", "-v", *arguments],
            stdin=subprocess.DEVNULL,
            stdout=stdout,
            stderr=subprocess.PIPE,
            text=True,
            env=env,
        )
        # Whoever waits for its next line is not left waiting for ever.
        self.guard = threading.Timer(2 * GUARD, self.process.kill)
        self.guard.daemon = True
        self.guard.start()
        self.first = self.process.stderr.readline()
        if not self.first.endswith(": listening\n"):
            self.process.wait(GUARD)
            raise AssertionError("dump did not listen: " + self.first)

    def signal(self, number):
        self.process.send_signal(number)

    def line(self):
        """The next line of output, as soon as it comes."""
        return self.process.stdout.readline()

    def result(self):
        """What came until it ended by itself: exit status, output, errors."""
        try:
            out, err = self.process.communicate(timeout=GUARD)
        except subprocess.TimeoutExpired:
            self.process.kill()
            out, err = self.process.communicate()
            raise AssertionError(f"dump did not end; it wrote:\n{out}\n{err}")
        lines = err.splitlines(keepends=True)
        counts = [line for line in lines if re.fullmatch(r".* frames? shown, \d+ lost\n", line)]
        self.counts = counts[0] if counts else None
        return (
            self.process.returncode,
            masked(out or ""),
            "".join(line for line in lines if line not in counts),
        )


class CliTest(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="roio-cli-")
        os.environ.pop("ROIO_ROBOT", None)
        os.environ["ROIO_RUNTIME_DIR"] = os.path.join(self.folder, "buses")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_cli(self, *arguments, stdin="", env=None):
        """Exit status, output with times masked, errors."""
        done = subprocess.run(
            [CLI, *arguments], input=stdin, capture_output=True, text=True, timeout=GUARD, env=env
        )
        return done.returncode, masked(done.stdout), done.stderr

    def send(self, *arguments, stdin=""):
        """A send that must succeed without a word."""
        self.assertEqual(self.run_cli("send", *arguments, stdin=stdin), (0, "", ""), arguments)

    def dump(self, *arguments, **options):
        dump = Dump(*arguments, **options)

        def end():
            dump.guard.cancel()
            if dump.process.poll() is None:
                dump.process.kill()
            dump.process.communicate()

        self.addCleanup(end)
        return dump


def main():
    unittest.main(verbosity=2)
