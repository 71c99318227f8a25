#!/usr/bin/env python3
"""The host examples print what they say at their top."""

import os
import re
import subprocess

from driver import GUARD, CliTest, main

EXAMPLES = os.environ["ROIO_CLI_EXAMPLES"]
SOURCES = os.path.join(os.path.dirname(__file__), "..", "..", "..", "examples", "host")


def promised(name):
    """The indented lines after "Expected output" in a source's opening comment."""
    with open(os.path.join(SOURCES, name + ".cpp")) as file:
        comment = re.match(r"(//.*\n)+", file.read())[0]
    return re.sub(r"(?m)^//   ", "", re.search(r"Expected output.*\n//\n((//   .*\n)+)", comment)[1])


class ExamplesTest(CliTest):
    def program(self, name, *arguments):
        return subprocess.Popen(
            [os.path.join(EXAMPLES, "example_" + name), *arguments],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )

    def test_send_and_receive_print_what_they_promise(self):
        receiver = self.program("receive")
        first = receiver.stdout.readline()  # it listens
        sender = self.program("send")
        self.assertEqual(sender.communicate(timeout=GUARD), (promised("send"), ""))
        out, err = receiver.communicate(timeout=GUARD)
        self.assertEqual((first + out, err), (promised("receive"), ""))
        self.assertEqual((sender.returncode, receiver.returncode), (0, 0))

    def test_a_loop_of_its_own_prints_what_it_promises(self):
        loop = self.program("poll_loop")
        first = loop.stdout.readline()  # the bus is there, and it listens
        sender = self.program("send")
        self.assertEqual(sender.communicate(timeout=GUARD), (promised("send"), ""))
        out, err = loop.communicate(timeout=GUARD)
        self.assertEqual((first + out, err), (promised("poll_loop"), ""))
        self.assertEqual((sender.returncode, loop.returncode), (0, 0))

    def test_asio_forwards_what_it_promises(self):
        gateway = self.program("asio_forward", "local:robot", "local:copy")
        first = gateway.stdout.readline()
        receiver = self.program("receive", "local:copy")
        greeting = receiver.stdout.readline()  # it listens
        sender = self.program("send", "local:robot")
        self.assertEqual(sender.communicate(timeout=GUARD), (promised("send"), ""))
        out, err = receiver.communicate(timeout=GUARD)
        self.assertEqual((greeting + out, err),
                         (promised("receive").replace("local:robot", "local:copy"), ""))
        out, err = gateway.communicate(timeout=GUARD)
        self.assertEqual((first + out, err), (promised("asio_forward"), ""))
        self.assertEqual((sender.returncode, receiver.returncode, gateway.returncode), (0, 0, 0))

    def test_loops_say_why_a_bus_is_not_there_and_go_on(self):
        loop = self.program("poll_loop", "serial:/dev/nosuchtty")
        self.assertIn("serial:/dev/nosuchtty: no such serial port", loop.stderr.readline())
        self.assertIsNone(loop.poll())
        loop.kill()
        loop.communicate(timeout=GUARD)

    def test_a_bus_that_is_none_is_one_line_and_a_failure(self):
        for name in ("send", "receive", "poll_loop"):
            program = self.program(name, "local:")
            out, err = program.communicate(timeout=GUARD)
            self.assertEqual((program.returncode, out), (1, ""))
            self.assertEqual(len(err.splitlines()), 1, err)


if __name__ == "__main__":
    main()
