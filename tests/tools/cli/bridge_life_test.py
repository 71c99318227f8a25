#!/usr/bin/env python3
"""A bridge sends a message in its time, or never: whatever becomes of the program that gave it."""

import signal
import subprocess
import time

from bridge_test import BridgeTest
from driver import CLI, GUARD, SLOWER, main


class NothingOldTest(BridgeTest):
    """The board is alone: nobody acknowledges. What was sent meanwhile must never be on the bus."""

    def setUp(self):
        super().setUp()
        self.board.say("alone")
        self.bus = "serial:" + self.port

    def expect_nothing_old(self):
        """Others come: all that they hear is what is sent from now on."""
        dump = self.dump("-n", "1", "local:robot")
        self.board.say("together")
        time.sleep(1.5 * SLOWER)  # in which old ones would come
        self.send(self.bus, "0.9", "99")
        self.assertEqual(dump.result(), (0, "0.10   -> 0.9     normal  message  [1]  99\n", ""))

    def test_a_message_ends_in_its_time_and_the_reason_is_said(self):
        self.assertEqual(
            self.run_cli("send", "--timeout", "500", self.bus, "0.2", "5A2D00"),
            (1, "", f"roio-cli: {self.bus}: not sent within 500 ms: nobody acknowledges, the bus is "
                    "error-passive; 0 messages sent before\n"))
        self.expect_nothing_old()

    def test_a_question_that_never_went_out_has_no_answer(self):
        self.assertEqual(
            self.run_cli("ask", "--timeout", "500", self.bus, "0.2", "01"),
            (1, "", f"roio-cli: {self.bus}: not sent within 500 ms: nobody acknowledges, the bus is "
                    "error-passive; 0 messages sent before\n"))
        self.board.say("together")
        ask = subprocess.Popen([CLI, "ask", "--timeout", "3000", self.bus + "?mode=listen", "0.2", "01"],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(ask.kill)
        self.send("--from", "0.2", "--count", "20", "--interval", "100", "local:robot", "0.10", "99")
        out, err = ask.communicate(timeout=GUARD)
        self.assertEqual((ask.returncode, out), (1, ""))
        self.assertIn("not sent: the bridge only listens; 0 messages sent before", err)

    def test_many_are_counted_as_they_were(self):
        self.assertEqual(
            self.run_cli("send", "--timeout", "500", "--count", "100", self.bus, "0.2", "01"),
            (1, "", f"roio-cli: {self.bus}: not sent within 500 ms: nobody acknowledges, the bus is "
                    "error-passive; 0 messages sent before\n"))
        self.expect_nothing_old()

    def test_a_bridge_that_only_listens_says_so(self):
        self.board.say("together")
        for count in ("1", "100"):
            self.assertEqual(
                self.run_cli("send", "--count", count, self.bus + "?mode=listen", "0.2", "01"),
                (1, "", f"roio-cli: {self.bus}: not sent: the bridge only listens; 0 messages sent "
                        "before\n"))
        self.assertEqual(self.run_cli("bridge", "set", self.port, "--mode", "normal"), (0, "", ""))

    def test_what_a_killed_program_left_is_taken_back(self):
        with subprocess.Popen([CLI, "send", "--timeout", "20000", "--count", "10", self.bus, "0.2", "01"],
                              stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as sender:
            self.board.wait_for("usb: can: error-passive, 500000 bit/s")  # it has begun to try
            sender.kill()
        time.sleep(1 * SLOWER)
        self.expect_nothing_old()

    def test_attached_frames_are_told_as_lost_and_do_not_come_later(self):
        attach = self.attach(self.port, "local:other")
        self.send("--count", "30", "local:other", "0.2", "01")
        attach.wait_for(f"{self.port}: bus is error-passive")
        time.sleep(2 * SLOWER)
        self.assertEqual(
            attach.result(),
            (128 + signal.SIGINT, "",
             f"roio-cli: {self.port} to local:other: 0 frames, 0 lost\n"
             f"roio-cli: local:other to {self.port}: 0 frames, 30 lost (30 not sent by {self.port})\n"))
        self.expect_nothing_old()

    def test_another_rate_sends_none_of_the_old_ones(self):
        attach = self.attach(self.port, "local:other")
        self.send("--count", "15", "local:other", "0.2", "01")
        attach.result()
        for rate in ("125000", "500000"):
            self.assertEqual(self.run_cli("bridge", "set", self.port, "--bitrate", rate), (0, "", ""))
        self.expect_nothing_old()


if __name__ == "__main__":
    main()
