#!/usr/bin/env python3
"""Boards alone: what they show, and what can be done to them."""

import fcntl
import json
import os
import select
import struct

from sim_driver import LEONARDO, MEGA, UNO, SimTest, main


class ShowTest(SimTest):
    def test_a_board_alone_and_its_end(self):
        self.assertEqual(
            self.run_sim("--for", "0.25", "--speed", "max", "uno=" + UNO),
            (0,
             "uno: serial: node 2\n"
             "uno: can: normal, 500000 bit/s\n"
             "bus: 0.250 s simulated, 0 frames, load 0.0 %, 0 errors\n", ""),
        )

    def test_names_that_were_not_given(self):
        status, out, err = self.run_sim(
            "--for", "0.1", "--speed", "max",
            "uno=" + UNO, "uno2:micro=" + LEONARDO, "uno=" + UNO, "mega=" + MEGA,
        )
        self.assertEqual((status, err), (0, ""))
        self.assertEqual(
            sorted(line for line in out.splitlines() if "serial" in line),
            ["mega: serial: node 2", "uno2: serial1: node 2", "uno3: serial: node 2", "uno: serial: node 2"],
        )

    def test_json_lines(self):
        status, out, err = self.run_sim(
            "--json", "--speed", "max", "--for", "0.3", "a:uno=" + UNO,
            "--do", "wait 0.1", "--do", 'a serial "Grüße" \x1b\\',
        )
        self.assertEqual((status, err), (0, ""))
        lines = [json.loads(line) for line in out.splitlines()]
        for line in lines:
            self.assertTrue(0 < line.pop("time") <= 0.3, line)
        self.assertEqual(lines, [
            {"type": "serial", "board": "a", "uart": 0, "text": "node 2"},
            {"type": "can", "board": "a", "state": "normal", "bitrate": 500000},
            {"type": "serial", "board": "a", "uart": 0, "text": 'said "Grüße" \x1b\\'},
            {"type": "summary", "frames": 0, "load": 0.0, "errors": 0, "behind": 0.0},
        ])

    def test_what_a_board_says_does_not_move_the_cursor(self):
        out = self.run_sim("--speed", "max", "--for", "0.3", "a:uno=" + UNO, "--do", "wait 0.1",
                           "--do", "a serial \x1b[2J\t\x7f")[1]
        self.assertIn("a: serial: said \\x1B[2J\t\\x7F\n", out)

    def test_a_chip_at_another_rate_than_the_bus(self):
        status, out, err = self.run_sim("--rate", "250000", "--for", "0.1", "--speed", "max",
                                        "a:uno=" + UNO)
        self.assertEqual(
            (status, err),
            (0, "roio-sim: a: its chip is set to 500000 bit/s, the bus runs at 250000 (see --rate, "
                "and --crystal)\n"),
        )
        self.assertIn("a: can: normal, 500000 bit/s\n", out)

    # Alone with a frame of another rate, its chip goes error-passive, which is no other rate.
    def test_another_rate_is_told_once(self):
        sim = self.sim("--rate", "250000", "--bus", "local:robot", "a:uno=" + UNO)
        sim.wait_for("a: can: normal, 500000 bit/s")
        sim.say("a serial ping")
        sim.wait_for("a: can: error-passive, 500000 bit/s")
        sim.say("quit")
        self.assertEqual(sim.result()[2].count("its chip is set to 500000 bit/s"), 1)

    def test_a_crystal_of_its_own(self):
        out = self.run_sim("--crystal", "b:8000000", "--for", "0.1", "--speed", "max",
                           "a:uno=" + UNO, "b:leonardo=" + LEONARDO)[1]
        self.assertIn("a: can: normal, 500000 bit/s\n", out)
        self.assertIn("b: can: normal, 250000 bit/s\n", out)

    def test_chip_select_on_another_pin_is_not_found(self):
        status, out, err = self.run_sim("--cs", "A3", "--for", "0.1", "--speed", "max",
                                        "uno=" + UNO)
        self.assertEqual((status, err), (0, "roio-sim: uno: its sketch uses SPI, but not pin A3, where the chip's "
                                            "select is; see --cs\n"))
        self.assertNotIn("can:", out)


    def test_boards_and_their_second_names(self):
        for board, image, kind in (("a:uno=", UNO, "7"), ("a:nano=", UNO, "7"), ("a:leonardo=", LEONARDO, "13"),
                                   ("a:micro=", LEONARDO, "13"), ("a:mega=", MEGA, "13")):
            with self.subTest(board):
                sim = self.sim(board + image, "--bus", "local:robot")
                sim.wait_for("a: can: normal, 500000 bit/s")
                self.send("local:robot", "0.2", "6F01")
                sim.wait_for(f"a: output: pin {kind} high")
                sim.end()

    def test_what_the_sketch_drives_is_said(self):
        for command, pin, what in (("pin 9 low", "9", "low"), ("press D9", "9", "low"),
                                   ("hold 10", "10", "low"), ("pin 13 high", "13", "high")):
            with self.subTest(command):
                sim = self.sim("a:uno=" + UNO, "--bus", "local:robot", "--do", "a " + command)
                sim.wait_for("a: can: normal, 500000 bit/s")
                self.send("local:robot", "0.2", "7605DC")  # a servo on pin 9
                sim.wait_for("a: servo: pin 9 at 93 degrees")
                sim.say("a " + command, "wait 0.05", "quit")
                status, _, err = sim.result()
                self.assertEqual(status, 0)
                # At first, for two of them, the pin is an input; then each command is told once.
                self.assertEqual(set(err.splitlines()), {
                    f"roio-sim: a: pin {pin}: the sketch drives this pin, so that {what} from outside "
                    "changes nothing"})

    def test_an_input_may_be_driven(self):
        status, _, err = self.run_sim("--speed", "max", "--for", "0.2", "uno=" + UNO, "--do", "uno pin 8 high",
                                      "--do", "uno hold A1", "--do", "uno analog A0 0.5")
        self.assertEqual((status, err), (0, ""))


class CommandTest(SimTest):
    BOTH = ("--do", "b hold 4", "--do", "wait 0.02", "--do", "b release 4", "a:uno=" + UNO,
            "b:uno=" + UNO)

    def test_two_boards_talk(self):
        sim = self.sim(*self.BOTH)
        sim.wait_for("a: can: normal, 500000 bit/s", "b: can: normal, 500000 bit/s")
        sim.say("a serial ping")
        # The question at 0.3, the answer at 0.2: identifier as the chip has it, length, data.
        sim.wait_for("b: serial: 80086002 01 70", "a: serial: 80084003 01 50")
        sim.say("quit")
        status, out, err = sim.result()
        self.assertEqual((status, err), (0, ""))
        self.assertRegex(out, r"^bus: [\d.]+ s simulated, 2 frames, load [\d.]+ %, 0 errors\n$")

    SPOKEN = ["wait 0.1", "uno serial one", "wait 0.1", "uno  serial two  words ", "wait 0.25",
              "uno reset", "wait 0.1", "quit", "uno serial never"]
    HEARD = ["uno: serial: " + text for text in ("node 2", "said one", "said two  words ", "node 2")]

    def test_commands_come_in_their_order_and_time(self):
        given = [word for line in self.SPOKEN for word in ("--do", line)]
        status, out, err = self.run_sim("--speed", "max", *given, "uno=" + UNO)
        self.assertEqual((status, err), (0, ""))
        self.assertEqual([line for line in out.splitlines() if "serial" in line], self.HEARD)
        self.assertIn("bus: 0.550 s simulated, 0 frames, load 0.0 %, 0 errors\n", out)

    def test_commands_from_standard_input(self):
        # When they are read, the machine decides; their order and distance not.
        status, out, err = self.run_sim("--speed", "max", "uno=" + UNO,
                                        stdin="\n".join(self.SPOKEN))
        self.assertEqual((status, err), (0, ""))
        self.assertEqual([line for line in out.splitlines() if "serial" in line], self.HEARD)

    def test_a_chip_without_its_cable(self):
        # Its INT and SO float: the program reads 0xFF and takes it for frames.
        status, out, err = self.run_sim(
            "--speed", "max", "--for", "0.2", "uno=" + UNO, "--do", "wait 0.1", "--do",
            "uno unplug", "--do", "wait 0.01", "--do", "uno plug")
        self.assertEqual((status, err), (0, ""))
        self.assertIn("uno: can: normal, 500000 bit/s\n", out)

    # what is typed, the line on standard error
    NOT_UNDERSTOOD = [
        ("jump", '"jump": expected a board\'s name and press, hold, release, pin, analog, serial, reset, '
                 'unplug or plug; or wait, help or quit, found "jump"'),
        ("hold 4", '"hold 4": expected a board\'s name first: NAME hold 4'),
        ("uno jump", '"uno jump": expected press, hold, release, pin, analog, serial, reset, unplug or '
                     'plug, found "jump"'),
        ("uno press", '"uno press": expected a pin such as 4 or A0'),
        ("uno press 4 5", '"uno press 4 5": expected nothing more, found "5"'),
        ("uno pin 4 up", '"uno pin 4 up": expected high, low or open, found "up"'),
        ("uno analog 0 1", '"uno analog 0 1": expected an analog input such as A0, found "0"'),
        ("uno analog A0 512", '"uno analog A0 512": expected 0..1 (0.5 is the middle) or volts such as '
                              '2.5V, 0..5, found "512"'),
        ("uno serialX hello", '"uno serialX hello": expected serial, or serial0 to serial3, found '
                              '"serialX"'),
        ("wait", '"wait": expected seconds, above 0 and at most 1000000, such as 0.25, found ""'),
        ("arm reset", 'no board "arm"; there is uno'),
        ("uno press 20", "a Uno has no pin 20"),
        ("uno analog A9 1", "a Uno has no analog input A9"),
        ("uno serial1 hello", "a Uno has no serial port 1"),
        ("uno unplug usb", '"uno unplug usb": expected nothing more, or serial, found "usb"'),
        ("uno plug serial 2", '"uno plug serial 2": expected nothing more, found "2"'),
        ("uno unplug serial", "uno: its serial port is no terminal; see --serial-pty"),
    ]

    def test_commands_that_are_not_understood(self):
        status, _, err = self.run_sim(
            "--speed", "max", "uno=" + UNO,
            stdin="".join(line + "\n" for line, _ in self.NOT_UNDERSTOOD) + "quit\n")
        self.assertEqual(status, 1)
        # Those that no board could understand are named when they are read, before any is done.
        self.assertEqual(sorted(err.splitlines()),
                         sorted("roio-sim: " + line for _, line in self.NOT_UNDERSTOOD))

    def test_a_script_that_goes_wrong_does_not_go_on_about_it(self):
        status, _, err = self.run_sim("--speed", "max", "uno=" + UNO, stdin=1000 * "uno jump\n" + "quit\n")
        self.assertEqual(status, 1)
        lines = err.splitlines()
        self.assertEqual(len(lines), 21)
        self.assertEqual(lines[-1], "roio-sim: and 980 commands more that could not be done")

    def test_help(self):
        status, _, err = self.run_sim("--speed", "max", "uno=" + UNO, stdin="help\nquit\n")
        self.assertEqual(status, 0)
        self.assertTrue(err.startswith("roio-sim: commands:\nNAME press PIN "), err)

    def test_it_goes_on_without_an_input(self):
        sim = self.sim("--for", "0.1", "--speed", "max", "uno=" + UNO, prefix=("sh", "-c", '"$0" "$@" <&-'))
        self.assertEqual(sim.result()[::2], (0, "roio-sim: standard input: Bad file descriptor\n"))

    def test_it_goes_on_at_the_end_of_its_input(self):
        self.assertEqual(self.run_sim("--speed", "max", "--for", "0.1", "uno=" + UNO)[0], 0)


TCGETS2, TCSETS2 = 0x802C542A, 0x402C542B  # any rate, which Python's termios cannot
TERMIOS2 = "IIIIB19sII"
BOTHER, CBAUD = 0o010000, 0o010017


class SerialPortTest(SimTest):
    LINK = property(lambda self: self.path("ttyACM0"))

    def terminal(self, path):
        terminal = os.open(path, os.O_RDWR | os.O_NOCTTY)
        self.addCleanup(os.close, terminal)
        return terminal

    def ask(self, terminal, line, answer):
        """Writes a line, and reads until the answer to it has come."""
        os.write(terminal, line + b"\n")
        seen = b""
        while answer not in seen:
            self.assertNotEqual(select.select([terminal], [], [], 60)[0], [], seen)
            seen += os.read(terminal, 100)

    def set_rate(self, terminal, rate):
        settings = list(struct.unpack(TERMIOS2, fcntl.ioctl(terminal, TCGETS2, bytes(44))))
        settings[2] = settings[2] & ~CBAUD | BOTHER
        settings[-2:] = rate, rate
        fcntl.ioctl(terminal, TCSETS2, struct.pack(TERMIOS2, *settings))

    def test_a_terminal(self):
        sim = self.sim("--serial-pty", "a", "a:uno=" + UNO)
        line = sim.out.next()
        self.assertRegex(line, r"^a: serial port: /dev/pts/\d+\n$")
        terminal = self.terminal(line.split()[-1])
        sim.wait_for("a: can: normal, 500000 bit/s")
        self.ask(terminal, b"hello", b"said hello\r\n")
        sim.say("quit")
        status, out, err = sim.result()
        self.assertEqual((status, err), (0, ""))
        self.assertNotIn("serial", out)

    def test_a_path_that_stays(self):
        sim = self.sim("--serial-pty", "a:" + self.LINK, "a:uno=" + UNO)
        self.assertEqual(sim.out.next(), f"a: serial port: {self.LINK}\n")
        before = self.terminal(self.LINK)
        sim.wait_for("a: can: normal, 500000 bit/s")
        self.ask(before, b"hello", b"said hello\r\n")

        sim.say("a unplug serial")
        sim.wait_for("a: serial port: unplugged")
        self.assertEqual(os.read(before, 100), b"")  # its end
        self.assertFalse(os.path.lexists(self.LINK))
        sim.say("a reset")
        # It says "node 2" to nobody.
        sim.say("wait 0.1", "a plug serial")
        sim.wait_for(f"a: serial port: {self.LINK}")
        self.ask(self.terminal(self.LINK), b"again", b"said again\r\n")
        self.assertEqual(os.read(before, 100), b"")

        sim.say("quit")
        status, _, err = sim.result()
        self.assertEqual((status, err),
                         (0, "roio-sim: a: 8 bytes lost: its serial port was unplugged\n"))
        self.assertFalse(os.path.lexists(self.LINK))

    def test_the_line_rate_counts(self):
        sim = self.sim("--serial-pty", "a:" + self.LINK, "a:uno=" + UNO)
        terminal = self.terminal(self.LINK)
        sim.wait_for("a: can: normal, 500000 bit/s")
        self.set_rate(terminal, 115200)
        self.ask(terminal, b"right", b"said right\r\n")
        self.set_rate(terminal, 250000)
        os.write(terminal, b"wrong\n")
        sim.say("wait 0.2", "a serial there", "wait 2.1", "a serial still", "wait 0.2", "quit")
        status, _, err = sim.result()
        self.assertEqual(status, 0)
        self.assertRegex(err, r"^roio-sim: a: \d+ bytes garbled: its serial port was set to another rate "
                              r"than the board's\n")

    def test_a_change_of_the_line_rate_is_no_fault(self):
        sim = self.sim("--serial-pty", "a:" + self.LINK, "a:uno=" + UNO)
        terminal = self.terminal(self.LINK)
        sim.wait_for("a: can: normal, 500000 bit/s")
        self.set_rate(terminal, 115200)
        self.ask(terminal, b"right", b"said right\r\n")
        self.set_rate(terminal, 250000)
        sim.say("a serial there", "wait 0.2", "quit")  # it answers
        self.assertEqual(sim.result()[::2], (0, ""))

    def test_a_line_rate_that_was_never_right(self):
        sim = self.sim("--serial-pty", "a:" + self.LINK, "a:uno=" + UNO)
        terminal = self.terminal(self.LINK)
        sim.wait_for("a: can: normal, 500000 bit/s")
        self.set_rate(terminal, 9600)
        sim.say("a serial there", "wait 0.2", "quit")
        status, _, err = sim.result()
        self.assertEqual(status, 0)
        self.assertRegex(err, r"^roio-sim: a: \d+ bytes garbled: ")

    def test_json_lines(self):
        status, out, err = self.run_sim(
            "--json", "--speed", "max", "--for", "0.1", "--serial-pty", "a:" + self.LINK, "a:uno=" + UNO,
            "--do", "wait 0.05", "--do", "a unplug serial", "--do", "a plug serial")
        self.assertEqual((status, err), (0, ""))
        lines = [json.loads(line) for line in out.splitlines()]
        self.assertEqual(
            [(line["board"], line["path"]) for line in lines if line["type"] == "serial-port"],
            [("a", self.LINK), ("a", None), ("a", self.LINK)])

    def test_a_path_that_is_taken(self):
        with open(self.LINK, "w") as file:
            file.write("a file")
        self.assertEqual(
            self.run_sim("--serial-pty", "a:" + self.LINK, "a:uno=" + UNO),
            (2, "", f"roio-sim: --serial-pty: {self.LINK}: expected nothing there, or a link to a pseudo "
                    "terminal: File exists\n"))
        self.assertEqual(os.path.getsize(self.LINK), 6)


if __name__ == "__main__":
    main()
