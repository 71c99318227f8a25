"""Runs roio-sim for the end-to-end tests, beside roio-cli (tests/tools/cli/driver.py).

ROIO_SIM names the program, ROIO_SIM_FIRMWARE the folder of node.MCU.elf. Deadlines are guards against
hanging; how fast a machine is, no test asks.
"""

import os
import queue
import re
import signal
import subprocess
import threading

from driver import GUARD, CliTest, main  # noqa: F401

SIM = os.environ["ROIO_SIM"]
FIRMWARE = os.environ["ROIO_SIM_FIRMWARE"]
UNO = os.path.join(FIRMWARE, "node.atmega328p.elf")
LEONARDO = os.path.join(FIRMWARE, "node.atmega32u4.elf")
MEGA = os.path.join(FIRMWARE, "node.atmega2560.elf")

# A slow machine says so, and is not wrong because of it.
SLOW = re.compile(r"roio-sim: cannot keep up: [\d.]+ s behind real time\n")
SLOW_SUMMARY = re.compile(r"bus: [\d.]+ s behind real time\n")


class Lines:
    """Lines as they come from a stream, read by a thread, so that neither side waits for the other."""

    def __init__(self, stream):
        self.stream = stream
        self.queue = queue.Queue()
        self.seen = []
        self.thread = threading.Thread(target=self.read, daemon=True)
        self.thread.start()

    def read(self):
        for line in self.stream:
            self.queue.put(line)
        self.queue.put("")

    def next(self):
        """The next line, as soon as it comes; at the end an empty one."""
        line = self.queue.get(timeout=GUARD)
        self.seen.append(line)
        return line

    def rest(self):
        return "".join(iter(self.next, ""))


class Sim:
    """A `roio-sim -v` that runs already."""

    def __init__(self, *arguments, prefix=()):
        self.process = subprocess.Popen(
            [*prefix, SIM, "-v", *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True,
        )
        self.out = Lines(self.process.stdout)
        self.err = Lines(self.process.stderr)
        self.first = self.err.next()
        if not self.first.endswith(": joined\n"):
            self.end()
            raise AssertionError("roio-sim did not start: " + self.first)

    def say(self, *lines):
        for line in lines:
            self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def wait_for(self, *lines):
        """Reads on until each of the lines has come, in any order and among others."""
        missing = set(lines)
        while missing:
            try:
                line = self.out.next()
            except queue.Empty:
                line = ""
            if not line:
                raise AssertionError(f"{missing} did not come, but:\n" + "".join(self.out.seen))
            missing.discard(line[:-1])

    def result(self):
        """What came until it ended: exit status, output, errors."""
        status = self.process.wait(GUARD)
        return status, SLOW_SUMMARY.sub("", self.out.rest()), SLOW.sub("", self.err.rest())

    def signal(self, number=signal.SIGINT):
        self.process.send_signal(number)

    def end(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        for lines in (self.out, self.err):
            lines.thread.join(GUARD)
        for stream in (self.process.stdin, self.process.stdout, self.process.stderr):
            try:
                stream.close()
            except BrokenPipeError:
                pass


class SimTest(CliTest):
    def sim(self, *arguments, **options):
        sim = Sim(*arguments, **options)
        self.addCleanup(sim.end)
        return sim

    def run_sim(self, *arguments, stdin="", env=None):
        """Exit status, output, errors."""
        done = subprocess.run(
            [SIM, *arguments], input=stdin, capture_output=True, text=True, timeout=GUARD, env=env
        )
        return done.returncode, SLOW_SUMMARY.sub("", done.stdout), SLOW.sub("", done.stderr)
