#!/usr/bin/env python3
"""`roio-cli bridge attach` on real SocketCAN: the bridge's firmware on a simulated board, and can-utils
that know nothing of it. Runs in scripts/lab: root, vcan0, vcan1."""

import fcntl
import os
import pty
import re
import signal
import struct
import termios
import time

from bridge_test import BridgeTest
from driver import SLOWER, CliTest, main
from lab_can_utils_test import Peer, frames, run

# Frames of every kind and length, all normal: an urgent one may pass them.
TRAFFIC = [f"{identifier + length:0{digits}X}#{'R' + str(length) if remote else 'A5' * length}"
           for digits, identifier in ((3, 0x700), (8, 0x1C000000))
           for remote in (False, True)
           for length in range(9)]
COUNT = len(TRAFFIC)


def written(log):
    """The frames of a log, with the length 0 of a remote frame written out."""
    return [re.sub("R$", "R0", frame) for frame in frames(log)]


class AttachTest(BridgeTest):
    def setUp(self):
        super().setUp()
        self.addCleanup(run, "ip", "link", "set", "vcan0", "up")

    def test_candump_sees_what_nodes_behind_the_bridge_send(self):
        self.attach(self.port, "vcan0")
        candump = Peer("candump", "-L", "-n", "1", "vcan0", interface="vcan0")
        self.send("local:robot", "--from", "0.3", "0.2", "5A2D00")
        self.assertEqual(frames(candump.output()), ["10004003#5A2D00"])

    def test_what_cansend_sends_reaches_nodes_behind_the_bridge(self):
        self.attach(self.port, "vcan0")
        behind = self.dump("-n", "1", "local:robot")
        run("cansend", "vcan0", "1000400A#5A2D00")
        self.assertEqual(behind.result(), (0, "0.10   -> 0.2     normal  message  [3]  5A 2D 00\n", ""))

    def test_frames_of_every_kind_and_length_go_both_ways_unchanged(self):
        attach = self.attach(self.port, "vcan0")
        # One at a time: the shortest frames at the pace of a full bus are more than an Uno reads.
        log = "".join(f"(0.0) x {frame}\n" for frame in TRAFFIC)
        behind = self.dump("-n", str(COUNT), "--log", "local:robot")
        self.send("--interval", "20", "vcan0", "-", stdin=log)
        self.assertEqual(written(behind.result()[1]), TRAFFIC)
        candump = Peer("candump", "-L", "-n", str(COUNT), "vcan0", interface="vcan0")
        self.send("--interval", "20", "local:robot", "-", stdin=log)
        self.assertEqual(written(candump.output()), TRAFFIC)
        self.assertEqual(
            attach.result(),
            (128 + signal.SIGINT, "",
             f"roio-cli: {self.port} to vcan0: {COUNT} frames, 0 lost\n"
             f"roio-cli: vcan0 to {self.port}: {COUNT} frames, 0 lost\n"),
        )

    def test_an_interface_that_is_down_is_told_its_losses_are_counted_and_it_comes_back(self):
        attach = self.attach("-v", self.port, "vcan0")
        run("ip", "link", "set", "vcan0", "down")
        attach.wait_for("vcan0: bus is down")
        self.send("--count", "10", "local:robot", "0.2", "01")
        attach.wait_for(f"{self.port} to vcan0: 0 frames, 10 lost (10 not taken by vcan0)")
        run("ip", "link", "set", "vcan0", "up")
        attach.wait_for("vcan0: bus is error-active")
        candump = Peer("candump", "-L", "-n", "1", "vcan0", interface="vcan0")
        self.send("local:robot", "0.3", "02")
        self.assertEqual(frames(candump.output()), ["1000600A#02"])
        status, out, err = attach.result()
        self.assertEqual((status, out), (128 + signal.SIGINT, ""))
        self.assertEqual(
            err.splitlines()[-2:],
            [f"roio-cli: {self.port} to vcan0: 1 frame, 10 lost (10 not taken by vcan0)",
             f"roio-cli: vcan0 to {self.port}: 0 frames, 0 lost"])

    def test_an_unplugged_bridge_loses_what_is_counted_and_comes_back(self):
        attach = self.attach("-v", self.port, "vcan0")
        self.board.say("usb unplug serial")
        attach.wait_for(f"{self.port}: bus is absent")
        run("cangen", "vcan0", "-g", "1", "-n", "10")
        attach.wait_for(f"vcan0 to {self.port}: 0 frames, 10 lost (10 not taken by {self.port})")
        self.board.say("usb plug serial")
        attach.wait_for(f"{self.port}: bus is error-active")
        behind = self.dump("-n", "1", "local:robot")
        run("cansend", "vcan0", "1000400A#02")
        self.assertEqual(behind.result()[1], "0.10   -> 0.2     normal  message  [1]  02\n")

    def test_frames_that_a_stopped_program_had_no_room_for_are_counted(self):
        as_user = ["setpriv", "--bounding-set", "-net_admin"]  # who may not ask for a bigger buffer
        attach = self.attach(self.port, "vcan0", prefix=as_user)
        attach.process.send_signal(signal.SIGSTOP)
        self.send("--count", "5000", "vcan0", "0.2", "01")
        attach.process.send_signal(signal.SIGCONT)
        self.send("vcan0", "0.2", "02")
        # What comes while the bridge and the program find one another again is lost, and counted, too.
        behind = self.dump("-n", "1", "-T", "55000", "local:robot", "to=0.3")
        tries = 0
        while behind.process.poll() is None:
            run("cansend", "vcan0", "1000600A#03")
            tries += 1
            time.sleep(0.2 * SLOWER)
        status = behind.result()[0]
        time.sleep(2 * SLOWER)  # for the last one to be handed on
        err = attach.result()[2]
        self.assertEqual(status, 0, err)
        counts = re.search(
            r"vcan0 to \S+: (\d+) frames?, (\d+) lost \((\d+) on the way from vcan0", err)
        self.assertIsNotNone(counts, err)
        sent, lost, early = map(int, counts.groups())
        self.assertGreater(early, 0)
        self.assertEqual(sent + lost, 5001 + tries, err)

    def test_one_bridge_an_interface(self):
        self.attach(self.port, "vcan0")
        self.assertEqual(
            self.run_cli("bridge", "attach", self.path("ttyACM1"), "vcan0"),
            (1, "", "roio-cli: vcan0: another bridge is attached to it; give this one an interface of "
                    "its own\n"))

    def test_no_such_interface(self):
        self.assertEqual(
            self.run_cli("bridge", "attach", self.port, "vcan7"),
            (2, "", "roio-cli: vcan7: no such network interface; `ip link add vcan7 type vcan; ip link "
                    "set vcan7 up` makes a virtual one, and local:NAME needs none\n"))

    def test_not_a_can_interface(self):
        self.assertEqual(
            self.run_cli("bridge", "attach", self.port, "lo"),
            (2, "", "roio-cli: lo: not a CAN interface; `ip link show type can` lists those, and "
                    "local:NAME needs none\n"))


class BusesTest(CliTest):
    def setUp(self):
        super().setUp()
        os.environ["ROIO_SERIAL_PORTS"] = self.path("none*")
        self.addCleanup(run, "ip", "link", "set", "vcan1", "up")

    def test_interfaces_with_state_and_bit_rate(self):
        run("ip", "link", "set", "vcan1", "down")
        controller, line = pty.openpty()
        self.addCleanup(os.close, controller)
        self.addCleanup(os.close, line)
        serial_line_can = 17  # N_SLCAN: makes an interface with a controller's settings
        fcntl.ioctl(line, termios.TIOCSETD, struct.pack("i", serial_line_can))
        run("ip", "link", "set", "can0", "type", "can", "bitrate", "125000")
        self.assertEqual(
            self.run_cli("buses"),
            (0,
             "vcan0  CAN interface (vcan), error-active\n"
             "vcan1  CAN interface (vcan), down\n"
             "can0   CAN interface, down, 125000 bit/s\n",
             ""))
        self.assertEqual(
            self.run_cli("buses", "--json"),
            (0,
             '{"bus":"vcan0","kind":"can","state":"error-active","interfaceKind":"vcan"}\n'
             '{"bus":"vcan1","kind":"can","state":"down","interfaceKind":"vcan"}\n'
             '{"bus":"can0","kind":"can","state":"down","bitrate":125000,"interfaceKind":"can"}\n',
             ""))


if __name__ == "__main__":
    main()
