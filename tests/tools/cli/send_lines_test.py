#!/usr/bin/env python3
"""roio-cli send BUS -: what lines it takes, in what order they go out, and what it says of the others."""

import json
import signal
import subprocess

from driver import CLI, GUARD, CliTest, main

BUS = "local:robot"

MESSAGE = {"type": "Roio", "isBroadcast": False, "address": 2, "subnet": 0, "messageLength": 1,
           "data": [7]}


class StdinTest(CliTest):
    def test_json_and_log_lines_carry_their_own_destination(self):
        dump = self.dump("-n", "4", BUS)
        broadcast = dict(MESSAGE, isBroadcast=True, priority="urgent", source="0.3")
        del broadcast["address"]
        self.send(
            "--from", "1.9", BUS, "-",
            # The urgent one first: a bus would let it pass.
            stdin=json.dumps(broadcast) + "\n\n" + json.dumps(MESSAGE) + "\n"
            "(1436509052.249713) can0 1000400A#5A2D00\n"
            "(1436509052.249714) can0 123#1122",
        )
        self.assertEqual(
            dump.result(),
            (0,
             "0.3    -> 0.*     urgent  message  [1]  07\n"
             "1.9    -> 0.2     normal  message  [1]  07\n"
             "0.10   -> 0.2     normal  message  [3]  5A 2D 00\n"
             "foreign  11-bit 123                [2]  11 22\n",
             ""),
        )

    def test_a_bad_line_is_named_and_the_others_are_sent(self):
        dump = self.dump("-n", "2", BUS)
        result = self.run_cli(
            "send", BUS, "-",
            stdin=json.dumps(MESSAGE) + "\n"
            "hello\n"
            + json.dumps(dict(MESSAGE, data=[256])) + "\n"
            "(1436509052.249713) can0 123##11122\n"
            "\n" + "x" * 70000 + "\n" + json.dumps(MESSAGE) + "\n",
        )
        self.assertEqual(result[:2], (1, ""))
        lines = result[2].splitlines()
        self.assertEqual(
            lines[0],
            'roio-cli: line 2: expected a JSON message {"type":"Roio",...}, a frame ID#DATA, or a '
            'line of a log "(TIME) BUS ID#DATA"',
        )
        self.assertEqual(
            lines[1],
            'roio-cli: line 3: JSON field "data": 256 at index 0; expected integers 0..255',
        )
        self.assertRegex(lines[2], r"^roio-cli: line 4: .*CAN FD")
        self.assertEqual(lines[3], "roio-cli: line 6: expected a line of at most 65536 bytes")
        self.assertEqual(lines[4:], ["roio-cli: local:robot: 2 messages sent, 4 lines refused"])
        self.assertEqual(
            dump.result(), (0, "0.10   -> 0.2     normal  message  [1]  07\n" * 2, "")
        )

    def test_a_flood_of_bad_lines_is_counted_not_named_one_by_one(self):
        status, out, err = self.run_cli("send", BUS, "-", stdin="x\n" * 100000)
        self.assertEqual((status, out), (1, ""))
        lines = err.splitlines()
        self.assertEqual([line.split(":")[1] for line in lines[:10]],
                         [f" line {number}" for number in range(1, 11)])
        self.assertEqual(lines[10:], [
            "roio-cli: line 11 and others, which are not named: their number follows at the end",
            "roio-cli: local:robot: 0 messages sent, 100000 lines refused"])

    def test_what_tells_of_another_bus_is_passed_over(self):
        dump = self.dump("-n", "1", BUS)
        result = self.run_cli(
            "send", BUS, "-",
            stdin='{"type":"lost","frames":12}\n'
            '{"type":"CAN","kind":"standard","id":291,"length":2,"data":[17,34],"timestamp":1.5}\n'
            '{"type":"state","state":"down"}\n'
            '{"type":"CAN FD","frames":12}\n'
            "DROPCOUNT: dropped 3 CAN frames on 'can0' socket (total drops 3)\n"
            "(1.000000) can0 20000004#0001000000000000\n")
        self.assertEqual(result, (0, "", "roio-cli: local:robot: 1 message sent, passed over: 5 bus reports\n"))
        self.assertEqual(dump.result(), (0, "foreign  11-bit 123                [2]  11 22\n", ""))

    def test_comments_are_passed_over_and_told_from_broken_lines(self):
        dump = self.dump("-n", "2", BUS)
        lines = "# a drive\n(1.000000) can0 123#11\n; over\n// and out\n(7) can0 123#22\n"
        said = "roio-cli: local:robot: 2 messages sent, passed over: 3 comments\n"
        self.assertEqual(self.run_cli("send", BUS, "-", stdin=lines), (0, "", said))
        self.assertEqual(dump.result()[1], "foreign  11-bit 123                [1]  11\n"
                                           "foreign  11-bit 123                [1]  22\n")
        self.assertEqual(
            self.run_cli("send", BUS, "-", stdin="# a drive\n(1.000000) can0 20000004#\n0.2 5A\n"),
            (1, "",
             'roio-cli: line 3: expected a JSON message {"type":"Roio",...}, a frame ID#DATA, or a '
             'line of a log "(TIME) BUS ID#DATA"\n'
             "roio-cli: local:robot: 0 messages sent, 1 line refused, passed over: 1 bus report, "
             "1 comment\n"))

    def test_a_second_interface_in_a_log_is_told_once(self):
        dump = self.dump("-n", "6", BUS)
        lines = "".join(f"(1.000000) {name} 123#0{i}\n"
                        for i, name in enumerate(("can0", "can0", "can1", "can0", "can2")))
        self.assertEqual(
            self.run_cli("send", BUS, "-", stdin="123#\n" + lines),
            (0, "",
             'roio-cli: line 4: the log is of several interfaces, "can0" and "can1" among them; the frames '
             "of all are sent to local:robot\n"))
        self.assertEqual(dump.result()[0], 0)

    def test_a_byte_order_mark_or_a_zero_byte_spoils_its_line(self):
        dump = self.dump("-n", "1", BUS)
        message = json.dumps(MESSAGE)
        self.assertEqual(
            self.run_cli("send", BUS, "-", stdin=f"\ufeff{message}\n{message}\0GARBAGE\n{message}\n"),
            (1, "",
             "roio-cli: line 1: begins with a byte order mark; expected text without one\n"
             f"roio-cli: line 2: a zero byte at byte {len(message)}; expected text\n"
             "roio-cli: local:robot: 1 message sent, 2 lines refused\n"))
        self.assertEqual(dump.result()[0], 0)

    def test_a_log_comes_out_in_its_order_whatever_the_identifiers(self):
        # As of a J1939 bus: priorities 3 and 6 beside each other, and an 11-bit one now and then.
        count = 3000
        identifiers = ["0CF00400", "18FEF100", "18FEEE00", "0CF00300", "1CECFF21", "123", "00000001"]
        frames = [f"{identifiers[(5 * i + i // 7) % 7]}#{i:08X}" for i in range(count)]
        for bus in (BUS, BUS + "-paced?bitrate=1000000"):
            with self.subTest(bus):
                dump = self.dump("-n", str(count), "--log", bus)
                self.send(bus, "-", stdin="".join(f"(1.000000) can0 {frame}\n" for frame in frames))
                status, out, err = dump.result()
                self.assertEqual((status, err), (0, ""))
                self.assertEqual([line.split()[2] for line in out.splitlines()], frames)

    def test_a_closed_input_is_an_error_not_a_wait(self):
        done = subprocess.run(["sh", "-c", f'exec "{CLI}" send local:closed - <&-'],
                              capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stderr.splitlines()[0]),
                         (1, "roio-cli: standard input: Bad file descriptor"))

    def test_nothing_to_read_is_nothing_to_send(self):
        self.send(BUS, "-", stdin="")

    def test_a_line_is_sent_when_it_comes_not_when_the_input_ends(self):
        dump = self.dump("-n", "1", BUS)
        sender = subprocess.Popen([CLI, "send", BUS, "-"], stdin=subprocess.PIPE, text=True)
        sender.stdin.write(json.dumps(MESSAGE) + "\n")
        sender.stdin.flush()
        self.assertEqual(dump.result()[1], "0.10   -> 0.2     normal  message  [1]  07\n")
        sender.stdin.close()
        self.assertEqual(sender.wait(GUARD), 0)

    def test_a_signal_ends_the_wait_for_input(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            sender = subprocess.Popen(
                [CLI, "send", BUS, "-"], stdin=subprocess.PIPE, stderr=subprocess.PIPE, text=True
            )
            dump = self.dump("-n", "1", BUS)
            sender.stdin.write(json.dumps(MESSAGE) + "\n")
            sender.stdin.flush()
            self.assertEqual(dump.result()[0], 0)
            sender.send_signal(number)
            self.assertEqual(sender.wait(GUARD), 128 + number)
            self.assertEqual(sender.stderr.read(), "roio-cli: local:robot: 1 message sent\n")
            sender.stdin.close()
            sender.stderr.close()

    def test_what_dump_writes_send_reads(self):
        for form in ("--json", "--log"):
            dump = self.dump("-n", "4", form, BUS)
            self.send("--urgent", BUS, "0.*", "0102")
            self.send(BUS, "123#1122")
            self.send(BUS, "1000400A#R4")
            self.send("--class", "system", "--from", "3.4", BUS, "0.2")
            out, _ = dump.process.communicate(timeout=GUARD)
            again = self.dump("-n", "4", BUS)
            self.send(BUS, "-", stdin=out)
            self.assertEqual(
                again.result(),
                (0,
                 "0.10   -> 0.*     urgent  message  [2]  01 02\n"
                 "foreign  11-bit 123                [2]  11 22\n"
                 "foreign  29-bit 1000400A           [4]  remote request\n"
                 "3.4    -> 0.2     normal  system   [0]\n",
                 ""),
            )

    def test_ten_thousand_lines_arrive_in_order(self):
        count = 10000
        dump = self.dump("-n", str(count), "--log", BUS)
        lines = [f"(1436509052.000000) robot 1000400A#{i:08X}" for i in range(count)]
        self.send(BUS, "-", stdin="\n".join(lines))
        status, out, err = dump.result()
        self.assertEqual((status, err), (0, ""))
        self.assertEqual(
            [line.split()[2] for line in out.splitlines()], [line.split()[2] for line in lines]
        )


if __name__ == "__main__":
    main()
