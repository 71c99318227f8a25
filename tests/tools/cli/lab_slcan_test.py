#!/usr/bin/env python3
"""The bridge's firmware, on a simulated board, spoken to in SLCAN: by slcand, the kernel's slcan and
can-utils, and by python-can. Runs in scripts/lab: root."""

import os
import subprocess
import time

import can

from bridge_test import BridgeTest
from driver import GUARD, SLOWER, main
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

    def open(self, **rate):
        return can.Bus(interface="slcan", channel=self.port, ttyBaudrate=115200, sleep_after_open=0.1,
                       **rate)

    def test_the_rates_of_python_can_are_those_of_the_bus(self):
        for rate, real in (({"bitrate": 83300}, 83333), ({"btr": "031C"}, 125000),
                           ({"btr": "051C"}, 83333), ({"bitrate": 500000}, 500000)):
            with self.open(**rate):
                self.board.wait_for(f"usb: can: normal, {real} bit/s")

    def test_at_a_rate_that_is_refused_it_is_on_no_bus(self):
        dump = self.dump("-T", "4000", "local:robot")
        with self.open(btr="0000") as bus:
            bus.send(can.Message(arbitration_id=0x1000400A, data=[0x5A, 0x2D, 0]))
            time.sleep(SLOWER)
        self.assertEqual(dump.result()[:2], (0, ""))


if __name__ == "__main__":
    main()
