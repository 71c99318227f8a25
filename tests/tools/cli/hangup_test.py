#!/usr/bin/env python3
"""roio-cli when its terminal goes away: what came is kept, and told where somebody can hear it."""

import os
import pty
import re
import signal
import socket

from driver import CLI, main
from live_driver import LiveTest

BUS = "local:robot"


class HangupTest(LiveTest):
    def setUp(self):
        super().setUp()
        # Whoever started the test may have had it ignored.
        before = signal.signal(signal.SIGHUP, signal.SIG_DFL)
        self.addCleanup(signal.signal, signal.SIGHUP, before)

    def on_terminal(self, *arguments):
        """The process that leads a session on a terminal, and the other end of that."""
        pid, end = pty.fork()
        if pid == 0:
            os.execv(CLI, [CLI, *arguments])
        return pid, end

    def read_until(self, end, pattern):
        seen = ""
        while not re.search(pattern, seen):
            seen += os.read(end, 4096).decode()

    def goes(self, pid, end):
        """The exit status when the terminal goes away."""
        os.close(end)
        return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])

    def test_a_record_has_all_that_came(self):
        pid, end = self.on_terminal("record", "-o", self.path("drive.log"), BUS)
        self.read_until(end, "recording to")
        self.send(BUS, "-", stdin="1000400A#01\n" * 100)
        self.assertEqual(self.goes(pid, end), 128 + signal.SIGHUP)
        with open(self.path("drive.log")) as log:
            self.assertEqual(log.read().count("1000400A#01\n"), 100)

    def test_a_dump_on_it_ends(self):
        pid, end = self.on_terminal("dump", "-v", BUS)
        self.read_until(end, "listening")
        self.send(BUS, "0.2", "5A")
        self.read_until(end, "5A")
        self.assertEqual(self.goes(pid, end), 128 + signal.SIGHUP)

    def test_a_dump_on_another_terminal_ends_though_nothing_comes(self):
        """Of which no signal tells."""
        end, terminal = pty.openpty()
        dump = self.dump(BUS, stdout=terminal)
        os.close(terminal)
        os.close(end)
        self.assertEqual(dump.result(), (128 + signal.SIGPIPE, "", ""))

    def test_a_dump_into_a_socket_ends_when_the_other_end_is_closed(self):
        reader, writer = socket.socketpair()
        dump = self.dump(BUS, stdout=writer)
        writer.close()
        reader.close()
        self.assertEqual(dump.result(), (128 + signal.SIGPIPE, "", ""))

    def test_a_dump_into_a_file_says_its_counts(self):
        dump = self.dump(BUS)
        self.send(BUS, "0.2", "5A")
        self.assertIn("5A", dump.line())
        dump.signal(signal.SIGHUP)
        self.assertEqual(dump.result(), (128 + signal.SIGHUP, "", ""))
        self.assertEqual(dump.counts, "roio-cli: local:robot: 1 frame shown, 0 lost\n")

    def test_attached_buses_say_what_was_forwarded(self):
        attach = self.running("attach", BUS, "local:desk")
        status, _, err = attach.end(signal.SIGHUP)
        self.assertEqual((status, err), (
            128 + signal.SIGHUP,
            "roio-cli: local:robot to local:desk: 0 frames, 0 lost\n"
            "roio-cli: local:desk to local:robot: 0 frames, 0 lost\n"))

    def test_who_ignores_it_goes_on(self):
        """As nohup has it."""
        signal.signal(signal.SIGHUP, signal.SIG_IGN)
        record = self.running("record", "-n", "1", "-o", self.path("drive.log"), BUS)
        record.process.send_signal(signal.SIGHUP)
        self.send(BUS, "0.2", "5A")
        self.assertEqual(record.end(), (
            0, "", f"roio-cli: {self.path('drive.log')}: 1 frame recorded, 0 lost\n"))


if __name__ == "__main__":
    main()
