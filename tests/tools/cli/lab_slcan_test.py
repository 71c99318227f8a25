#!/usr/bin/env python3
"""The bridge's firmware, on a simulated board, spoken to in SLCAN: by slcand, the kernel's slcan and
can-utils, and by python-can. Runs in scripts/lab: root."""

import os
import subprocess

import can

from bridge_test import BridgeTest
from driver import GUARD, main
from lab_can_utils_test import Peer, frames, run, wait_until

FRAMES = ["123#A5", "7FF#", "1000400A#5A2D00", "1FFFFFFF#0102030405060708"]


class SlcandTest(BridgeTest):
    def setUp(self):
        super().setUp()
        terminal = os.path.relpath(os.path.realpath(self.port), "/dev")
        self.slcand = subprocess.Popen(["slcand", "-F", "-o", "-c", "-s6", "-S115200", terminal, "slcan0"])
        self.addCleanup(self.end)
        wait_until(lambda: os.path.exists("/sys/class/net/slcan0"))
        run("ip", "link", "set", "slcan0", "up")

    def end(self):
        self.slcand.terminate()
        self.slcand.wait(GUARD)

    def test_candump_sees_what_nodes_behind_the_bridge_send(self):
        candump = Peer("candump", "-L", "-n", str(len(FRAMES)), "slcan0", interface="slcan0")
        for frame in FRAMES:
            self.send("--interval", "20", "local:robot", "-", stdin=f"(0.0) x {frame}\n")
        self.assertEqual(frames(candump.output()), FRAMES)

    def test_what_cansend_sends_reaches_nodes_behind_the_bridge(self):
        behind = self.dump("-n", str(len(FRAMES)), "--log", "local:robot")
        for frame in FRAMES:
            run("cansend", "slcan0", frame)
        self.assertEqual(frames(behind.result()[1]), FRAMES)


class PythonCanTest(BridgeTest):
    def test_python_can_sends_and_receives(self):
        with can.Bus(interface="slcan", channel=self.port, ttyBaudrate=115200, bitrate=500000,
                     sleep_after_open=0.1) as bus:
            behind = self.dump("-n", "1", "--log", "local:robot")
            bus.send(can.Message(arbitration_id=0x1000400A, data=[0x5A, 0x2D, 0]))
            self.assertEqual(frames(behind.result()[1]), ["1000400A#5A2D00"])
            self.send("local:robot", "--from", "0.3", "0.2", "0102")
            message = bus.recv(GUARD)
            self.assertEqual((message.arbitration_id, message.is_extended_id, bytes(message.data)),
                             (0x10004003, True, b"\x01\x02"))


if __name__ == "__main__":
    main()
