#!/usr/bin/env python3
"""roio-cli with a bridge: the real firmware on a simulated board, its UART a terminal, its CAN bus joined
to local:robot."""

import json
import os
import re
import signal
import socket
import subprocess
import sys
import unittest

from driver import CLI, GUARD, main

sys.path.append(os.path.join(os.path.dirname(__file__), "..", "sim"))
from sim_driver import Lines, Sim, SimTest  # noqa: E402

IMAGES = os.environ["ROIO_SIM_IMAGES"]
IN_USE = "another program has the port open; `fuser -v` with the port's name tells which"

SHOWN = """\
{port}: uno, firmware 0.1.0
  bit rate     500000 bit/s
  mode         normal
  state        error-active, error counters: transmit 0, receive 0
  address      0.254
  crystal      16 MHz
  INT line     wired
  serial line  1000000 bit/s
from the bus to this computer, since the board's reset:
  frames lost in the bridge, the line being full     0
  times the controller lost frames                   0
  frames from the controller that were none          0
from this computer to the bus, since the board's reset:
  frames sent and acknowledged                       0
  frames given up                                    0
  frames the controller was restarted under          0
  damaged records, repeated                          0
  bytes lost for coming too fast                     0
the controller, since the board's reset:
  errors found in frames                             0
  times bus-off                                      0
  times it was lost and started anew                 0
the serial line, since it was opened just now:
  sessions with the bridge                           1
  frames from the bridge that did not come           0
  damaged records from the bridge                    0
  frames to the bridge repeated                      0
  requests to the bridge repeated                    0
  line rates that failed the trial                   0
  times the line rate was lowered                    0
"""


def without_repeats(text):
    """The text without how often something was repeated, which a machine that is late decides."""
    return re.sub(r"(?m)(repeated +)\d+$", r"\1N", text)


class Attach:
    """A `roio-cli bridge attach` that is attached already."""

    def __init__(self, *arguments, prefix=()):
        self.process = subprocess.Popen(
            [*prefix, CLI, "bridge", "attach", *arguments], stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )
        self.err = Lines(self.process.stderr)
        self.first = self.err.next()
        if ": attached to " not in self.first:
            self.end()
            raise AssertionError("not attached: " + self.first)

    def wait_for(self, line):
        while True:
            found = self.err.next()
            if found == f"roio-cli: {line}\n":
                return
            if not found:
                raise AssertionError(f"{line!r} did not come, but:\n" + "".join(self.err.seen))

    def result(self, number=signal.SIGINT):
        """What it says at its end: exit status, output, errors."""
        self.process.send_signal(number)
        status = self.process.wait(GUARD)
        return status, self.process.stdout.read(), self.err.rest()

    def end(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.err.thread.join(GUARD)
        self.process.stdout.close()
        self.process.stderr.close()


def start_bridge(test, bus="local:robot", board="uno"):
    """A board that is there, and the path of its terminal."""
    port = test.path("ttyACM0")
    image = os.path.join(IMAGES, board, "bridge_usb.elf")
    board = Sim("--bus", bus, "--serial-pty", "usb:" + port, f"usb:{board}={image}")
    test.addCleanup(board.end)
    board.wait_for("usb: can: normal, 500000 bit/s")
    return board, port


class BridgeTest(SimTest):
    def setUp(self):
        super().setUp()
        self.board, self.port = start_bridge(self)
        os.environ["ROIO_SERIAL_PORTS"] = self.port

    def attach(self, *arguments, **options):
        attach = Attach(*arguments, **options)
        self.addCleanup(attach.end)
        return attach

    def shown(self):
        status, out, err = self.run_cli("bridge", "show", "--json", self.port)
        self.assertEqual((status, err), (0, ""))
        return json.loads(out)


class LeonardoTest(SimTest):
    """Over the USB of its processor."""

    def test_frames_go_both_ways_and_there_is_no_line_rate(self):
        _, port = start_bridge(self, board="leonardo")
        dump = self.dump("-n", "1", "local:robot")
        self.send("serial:" + port, "0.2", "5A2D00")
        self.assertEqual(dump.result()[0], 0)
        dump = self.dump("-n", "1", "serial:" + port)
        self.send("local:robot", "0.2", "5A2D01")
        self.assertEqual(dump.result()[0], 0)
        status, out, err = self.run_cli("bridge", "show", port)
        self.assertEqual((status, err), (0, ""))
        self.assertIn(f"{port}: leonardo, firmware", out)
        self.assertIn("  serial line  USB\n", out)


class ShowTest(BridgeTest):
    def test_says_what_the_bridge_is_and_has_counted(self):
        for name in (self.port, "serial:" + self.port, "auto"):
            status, out, err = self.run_cli("bridge", "show", name)
            self.assertEqual((status, err), (0, ""))
            self.assertEqual(without_repeats(out), without_repeats(SHOWN.format(port=self.port)))

    def test_json_is_one_object_with_the_same(self):
        dump = self.dump("-n", "5", "local:robot")
        self.send("--count", "5", "serial:" + self.port, "0.2", "01")
        self.assertEqual(dump.result()[0], 0)
        status, out, err = self.run_cli("bridge", "show", "--json", self.port)
        self.assertEqual((status, err), (0, ""))
        self.assertEqual(
            re.sub(r'"(damaged|resent|retries)":\d+', r'"\1":N', out),
            f'{{"port":"{self.port}","board":"uno","firmware":"0.1.0","bitrate":500000,'
            '"realBitrate":500000,"mode":"normal",'
            '"state":"error-active","transmitErrors":0,"receiveErrors":0,"address":"0.254",'
            '"crystalKhz":16000,"interruptWired":true,"lineRate":1000000,'
            '"counters":{"dropped":0,"overflows":0,"discarded":0,"sent":5,"notSent":0,"unknown":0,'
            '"damaged":N,"overruns":0,"messageErrors":0,"busOffs":0,"chipLosses":0},'
            '"line":{"sessions":1,"lost":0,"damaged":N,"resent":N,"retries":N,"failedTrials":0,'
            '"stepDowns":0}}\n',
        )

    def test_a_port_that_another_program_has(self):
        self.dump("serial:" + self.port)
        self.assertEqual(self.run_cli("bridge", "show", self.port),
                         (1, "", f"roio-cli: serial:{self.port}: {IN_USE}\n"))

    def test_a_port_without_a_bridge(self):
        self.assertEqual(
            self.run_cli("bridge", "show", self.path("ttyACM7")),
            (2, "",
             f"roio-cli: serial:{self.path('ttyACM7')}: no such serial port; `ls /dev/ttyACM* "
             "/dev/ttyUSB*` lists those that are plugged in, and serial:auto finds a bridge among "
             "them\n"),
        )


class SetTest(BridgeTest):
    def set(self, *arguments):
        self.assertEqual(self.run_cli("bridge", "set", self.port, *arguments), (0, "", ""))

    def test_sets_what_is_asked_for_and_nothing_else(self):
        # arguments, what is different then
        steps = [
            (["--bitrate", "125000"], {"bitrate": 125000}),
            (["--mode", "listen"], {"mode": "listen"}),
            (["--address", "3.7"], {"address": "3.7"}),
            (["--address", "none"], {"address": None}),
            (["--bitrate", "500000", "--mode", "loopback", "--address", "31.254"],
             {"bitrate": 500000, "mode": "loopback", "address": "31.254"}),
            (["--mode", "normal"], {"mode": "normal"}),
        ]
        keys = ("bitrate", "mode", "address")
        expected = {"bitrate": 500000, "mode": "normal", "address": "0.254"}
        for arguments, changes in steps:
            with self.subTest(arguments):
                self.set(*arguments)
                expected |= changes
                shown = self.shown()
                self.assertEqual({key: shown[key] for key in keys}, expected)
        self.board.wait_for("usb: can: normal, 125000 bit/s", "usb: can: listen-only, 125000 bit/s",
                            "usb: can: loopback", "usb: can: normal, 500000 bit/s")

    def test_what_the_bridge_refuses_is_said(self):
        self.assertEqual(
            self.run_cli("bridge", "set", self.port, "--bitrate", "980000"),
            (1, "",
             f"roio-cli: serial:{self.port}: bit rate 980000, mode normal: the controller cannot make "
             "this bit rate from its crystal: the bridge refused\n"),
        )
        self.assertEqual(self.shown()["bitrate"], 500000)


    def test_a_rate_that_the_crystal_nearly_makes_is_taken_and_the_true_one_shown(self):
        for asked, real in ((83300, 83333), (33300, 33333), (95200, 95238)):
            self.set("--bitrate", str(asked))
            self.board.wait_for(f"usb: can: normal, {real} bit/s")
            shown = self.shown()
            self.assertEqual((shown["bitrate"], shown["realBitrate"]), (asked, real))
            self.assertIn(f"  bit rate     {asked} bit/s: {real} is what the crystal makes\n",
                          self.run_cli("bridge", "show", self.port)[1])
        # In the name of the bus, too, and no session is lost over the difference.
        bus = f"serial:{self.port}?bitrate=83300"
        self.assertEqual(self.run_cli("dump", "-v", "-T", "1500", bus),
                         (0, "", f"roio-cli: serial:{self.port}: listening\n"
                                 f"roio-cli: serial:{self.port}: 0 frames shown, 0 lost\n"))


class IdentifyTest(BridgeTest):
    def test_a_bridge_that_blinks_goes_on_working(self):
        # An Uno's own LED is SPI's clock: what blinks is its USB chip's, which no board here has.
        for seconds in ("255", "0"):
            self.assertEqual(self.run_cli("bridge", "identify", self.port, "--seconds", seconds),
                             (0, "", ""))
            self.assertEqual(self.shown()["state"], "error-active")


class BusesTest(BridgeTest):
    def bridges(self, *options):
        """The lines of local buses and bridges; what CAN interfaces there are, the machine decides."""
        status, out, err = self.run_cli("buses", *options)
        self.assertEqual((status, err), (0, ""))
        return [line for line in out.splitlines() if "CAN interface" not in line and
                '"kind":"can"' not in line]

    def test_lists_what_can_be_opened(self):
        width = len("serial:" + self.port)
        self.assertEqual(
            [re.sub(" +", " ", line) for line in self.bridges()],
            ["local:robot local bus",
             f"serial:{self.port} bridge, uno, error-active, firmware 0.1.0, 500000 bit/s"])
        self.assertEqual({line.index("  ") for line in self.bridges()}, {len("local:robot"), width})

    def test_json_lines(self):
        self.assertEqual(
            self.bridges("--json"),
            ['{"bus":"local:robot","kind":"local"}',
             f'{{"bus":"serial:{self.port}","kind":"serial","state":"error-active","bitrate":500000,'
             '"board":"uno","firmware":"0.1.0"}'])

    def test_a_port_that_another_program_has_is_listed_with_the_reason(self):
        self.dump("serial:" + self.port)
        self.assertEqual(self.bridges()[-1],
                         f"serial:{self.port}  no bridge: another program has it open")
        self.assertEqual(
            self.bridges("--json")[-1],
            f'{{"bus":"serial:{self.port}","kind":"serial","error":"another program has it open"}}')

    def test_a_bus_that_is_named_can_be_opened(self):
        for line in self.bridges("--json"):
            dump = self.dump("-T", "1", json.loads(line)["bus"])
            self.assertEqual(dump.result(), (0, "", ""))


class AttachTest(BridgeTest):
    def test_frames_go_both_ways(self):
        attach = self.attach(self.port, "local:other")
        self.assertEqual(attach.first, f"roio-cli: {self.port}: attached to local:other\n")
        behind = self.dump("-n", "1", "local:robot", "from=0.10")
        self.send("local:other", "0.2", "5A2D00")
        self.assertEqual(behind.result(), (0, "0.10   -> 0.2     normal  message  [3]  5A 2D 00\n", ""))
        before = self.dump("-n", "100", "--log", "local:other")
        sent = "".join(f"(0.0) robot {frame:08X}#{frame:04X}\n" for frame in range(100))
        self.send("local:robot", "-", stdin=sent)
        status, out, err = before.result()
        self.assertEqual((status, err), (0, ""))
        self.assertEqual([line.split()[2] for line in out.splitlines()],
                         [line.split()[2] for line in sent.splitlines()])
        self.assertEqual(
            attach.result(),
            (128 + signal.SIGINT, "",
             f"roio-cli: {self.port} to local:other: 100 frames, 0 lost\n"
             f"roio-cli: local:other to {self.port}: 1 frame, 0 lost\n"),
        )

    def test_an_unplugged_bridge_is_told_its_losses_are_counted_and_it_comes_back(self):
        attach = self.attach("-v", self.port, "local:other")
        self.board.say("usb unplug serial")
        attach.wait_for(f"{self.port}: bus is absent")
        self.send("--count", "20", "local:other", "0.2", "01")
        attach.wait_for(f"local:other to {self.port}: 0 frames, 20 lost (20 not taken by {self.port})")
        self.board.say("usb plug serial")
        attach.wait_for(f"{self.port}: bus is error-active")
        behind = self.dump("-n", "1", "local:robot")
        self.send("local:other", "0.3", "02")
        self.assertEqual(behind.result()[:2], (0, "0.10   -> 0.3     normal  message  [1]  02\n"))
        status, out, err = attach.result(signal.SIGTERM)
        self.assertEqual((status, out), (128 + signal.SIGTERM, ""))
        self.assertEqual(
            err.splitlines()[-1],
            f"roio-cli: local:other to {self.port}: 1 frame, 20 lost (20 not taken by {self.port})")

    def test_a_bridge_alone_on_its_bus_does_not_send_and_that_is_counted(self):
        attach = self.attach(self.port, "local:other")
        self.board.say("usb unplug")
        self.send("--count", "5", "local:other", "0.2", "01")
        attach.wait_for(f"{self.port}: bus is down")
        status, out, err = attach.result()
        self.assertEqual((status, out), (128 + signal.SIGINT, ""))
        sent, lost = map(int, re.search(
            rf"local:other to {re.escape(self.port)}: (\d+) frames?, (\d+) lost", err).groups())
        self.assertEqual((sent + lost, lost > 0), (5, True), err)

    def test_a_port_that_another_program_has(self):
        self.attach(self.port, "local:other")
        self.assertEqual(self.run_cli("bridge", "attach", self.port, "local:third"),
                         (1, "", f"roio-cli: serial:{self.port}: {IN_USE}\n"))


class RecordTest(BridgeTest):
    """The board's bus is local:robot, which sees what goes through the board, and the other way round. All frames are
    normal: on local:robot, an urgent one that roio-sim hands over passes those that wait."""

    def recording(self, name, bus, count):
        record = subprocess.Popen([CLI, "record", "-n", str(count), "-o", self.path(name), bus],
                                  stderr=subprocess.PIPE, text=True)
        self.addCleanup(record.kill)
        self.assertIn(": recording to ", record.stderr.readline())
        return record

    def frames_of(self, record, name):
        self.assertRegex(record.communicate(timeout=GUARD)[1], r": \d+ frames recorded, 0 lost\n$")
        self.assertEqual(record.returncode, 0)
        with open(self.path(name)) as log:
            return [line.split()[2] for line in log]

    def test_what_is_played_to_a_board_and_recorded_from_it_is_whole_and_in_order(self):
        frames = [f"{identifier}#{number:04X}" for number in range(30)
                  for identifier in ("1000400A", "1400400A")]
        with open(self.path("drive.log"), "w") as log:
            log.writelines(f"(1.{number:06}) can0 {frame}\n" for number, frame in enumerate(frames))
        for source, target in (("serial:" + self.port, "local:robot"), ("local:robot", "serial:" + self.port)):
            with self.subTest(source=source):
                record = self.recording("back.log", target, len(frames))
                status, out, err = self.run_cli("play", "--timeout", "60000", self.path("drive.log"), source)
                self.assertEqual((status, out), (0, ""), err)
                self.assertEqual(self.frames_of(record, "back.log"), frames)
                os.remove(self.path("back.log"))


class NothingTest(SimTest):
    def test_what_to_do_when_there_is_no_bus(self):
        os.environ["ROIO_SERIAL_PORTS"] = self.path("ttyACM*")
        status, out, err = self.run_cli("buses")
        if "CAN interface" in out:
            raise unittest.SkipTest("this machine has CAN interfaces")
        self.assertEqual((status, out), (0, ""))
        self.assertEqual(
            err,
            "roio-cli: no CAN interface: plug in an adapter, or `ip link add vcan0 type vcan; ip link "
            "set vcan0 up` makes a virtual one\n"
            "roio-cli: no local bus: `roio-cli dump local:robot` makes one\n"
            "roio-cli: no serial port with a bridge: plug in an Arduino with the bridge_usb firmware, "
            "or name its port in ROIO_SERIAL_PORTS\n")

    def test_what_a_killed_program_left_is_no_bus(self):
        os.environ["ROIO_SERIAL_PORTS"] = self.path("ttyACM*")
        folder = os.environ["ROIO_RUNTIME_DIR"]
        os.mkdir(folder, 0o700)
        with socket.socket(socket.AF_UNIX) as left:
            left.bind(os.path.join(folder, "dead.sock"))
        for name in ("no socket.sock", "other"):
            with open(os.path.join(folder, name), "w"):
                pass
        self.assertNotIn("local:", self.run_cli("buses")[1])

    def test_a_file_that_is_no_port(self):
        with open(self.path("file"), "w"):
            pass
        self.assertEqual(
            self.run_cli("bridge", "show", self.path("file")),
            (2, "", f"roio-cli: serial:{self.path('file')}: not a serial port; expected one such as "
                    "/dev/ttyACM0\n"))


if __name__ == "__main__":
    main()
