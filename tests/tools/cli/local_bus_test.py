#!/usr/bin/env python3
"""roio-cli on local buses: what send sends, dump shows, in every form; endings and signals."""

import calendar
import os
import pty
import select
import signal
import subprocess
import time

from driver import CLI, GUARD, CliTest, main

BUS = "local:robot"


class SendTest(CliTest):
    def shown(self, *arguments):
        """What dump shows of one send."""
        dump = self.dump("-n", "1", BUS)
        self.send(*arguments)
        status, out, err = dump.result()
        self.assertEqual((status, err), (0, ""))
        return out

    def test_every_way_to_say_a_message(self):
        bytes_5a2d00 = "0.10   -> 0.2     normal  message  [3]  5A 2D 00\n"
        for options, message, line in [
            ([], ["0.2", "5A2D00"], bytes_5a2d00),
            ([], ["0.2", "5a.2d.00"], bytes_5a2d00),
            ([], ["0.2", "--dec", "90", "45", "0"], bytes_5a2d00),
            (["--dec"], ["0.2", "90", "45", "0"], bytes_5a2d00),
            ([], ["0.2"], "0.10   -> 0.2     normal  message  [0]\n"),
            ([], ["0.2", "5A 2D 00"], bytes_5a2d00),
            ([], ["0.2", "5A", "2D", "00"], bytes_5a2d00),
            ([], ["--", "0.2", "5A2D00"], bytes_5a2d00),
            ([], ["0.2", "--", "5A2D00"], bytes_5a2d00),
            ([], ["1000400A#5A2D00"], bytes_5a2d00),
            ([], ["123#DEAD"], "foreign  11-bit 123                [2]  DE AD\n"),
            ([], ["123#R4"], "foreign  11-bit 123                [4]  remote request\n"),
            ([], ["123#R8_F"], "foreign  11-bit 123                [8]  remote request\n"),
            ([], ["1000400A#0102030405060708_9"],
             "0.10   -> 0.2     normal  message  [8]  01 02 03 04 05 06 07 08\n"),
            ([], ["0.*", "01"], "0.10   -> 0.*     normal  message  [1]  01\n"),
            ([], ["0.255", "01"], "0.10   -> 0.*     normal  message  [1]  01\n"),
            ([], ["31.254", "0102030405060708"],
             "0.10   -> 31.254  normal  message  [8]  01 02 03 04 05 06 07 08\n"),
            (["--urgent"], ["0.2", "01"], "0.10   -> 0.2     urgent  message  [1]  01\n"),
            (["--from", "31.254"], ["0.2", "01"],
             "31.254 -> 0.2     normal  message  [1]  01\n"),
            (["--class", "message"], ["0.2", "01"],
             "0.10   -> 0.2     normal  message  [1]  01\n"),
            (["--class", "system"], ["0.2", "01"],
             "0.10   -> 0.2     normal  system   [1]  01\n"),
            (["--class=stream"], ["0.2", "01"], "0.10   -> 0.2     normal  stream   [1]  01\n"),
        ]:
            with self.subTest(options + message):
                self.assertEqual(self.shown(*options, BUS, *message), line)

    def test_count_sends_as_often(self):
        dump = self.dump("-n", "101", BUS)
        self.send("--count", "100", BUS, "0.2", "01")
        self.send(BUS, "0.3")
        self.assertEqual(
            dump.result(),
            (0,
             "0.10   -> 0.2     normal  message  [1]  01\n" * 100 +
             "0.10   -> 0.3     normal  message  [0]\n",
             ""),
        )

    def test_interval_spaces_the_messages_out(self):
        dump = self.dump("-n", "3", "--log", BUS)
        self.send("--count", "3", "--interval", "50", BUS, "0.2", "01")
        out, _ = dump.process.communicate(timeout=GUARD)
        times = [float(line[1 : line.index(")")]) for line in out.splitlines()]
        # Sleeping too long is the machine's affair; too short would be ours. The hub's clock takes
        # the time some way behind.
        self.assertGreater(times[2] - times[0], 0.050)

    def test_count_zero_goes_on_until_interrupted(self):
        dump = self.dump("-n", "5", BUS)
        sender = subprocess.Popen(
            [CLI, "send", "--count", "0", "--interval", "5", BUS, "0.2", "01"],
            stderr=subprocess.PIPE, text=True,
        )
        self.assertEqual(dump.result()[0], 0)
        sender.send_signal(signal.SIGINT)
        _, err = sender.communicate(timeout=GUARD)
        self.assertEqual(sender.returncode, 128 + signal.SIGINT)
        # Some may have gone out after the dump was gone.
        self.assertRegex(err, r"^(roio-cli: local:robot: nobody else was there to have \d+ messages?\n)?"
                              r"roio-cli: local:robot: \d+ messages sent\n$")


class FormTest(CliTest):
    def shown(self, *options):
        dump = self.dump("-n", "3", *options, BUS)
        self.send(BUS, "0.2", "5A2D00")
        self.send(BUS, "-", stdin="(1.000000) x 123#R4\n(1.000000) x 1C00400A#11\n")
        status, out, err = dump.result()
        self.assertEqual((status, err), (0, ""))
        return out

    def test_readable(self):
        self.assertEqual(
            self.shown(),
            "0.10   -> 0.2     normal  message  [3]  5A 2D 00\n"
            "foreign  11-bit 123                [4]  remote request\n"
            "foreign  29-bit 1C00400A           [1]  11  (reserved class)\n",
        )

    def test_times(self):
        for mode, stamp in (("a", "(0000000000.000000)"), ("d", "(000.000000)"),
                            ("z", "(000.000000)")):
            lines = [
                "0.10   -> 0.2     normal  message  [3]  5A 2D 00\n",
                "foreign  11-bit 123                [4]  remote request\n",
                "foreign  29-bit 1C00400A           [1]  11  (reserved class)\n",
            ]
            if mode == "a":  # narrower, so that 80 columns do
                lines = [
                    "0.10   -> 0.2    normal message [3] 5A 2D 00\n",
                    "foreign 11-bit 123              [4] remote request\n",
                    "foreign 29-bit 1C00400A         [1] 11  (reserved class)\n",
                ]
            self.assertEqual(self.shown("-t", mode), "".join(f"{stamp} {line}" for line in lines))

    def test_time_with_date(self):
        dump = self.dump("-n", "1", "-t", "A", BUS, env=dict(os.environ, TZ="UTC"))
        before = time.time()
        self.send(BUS, "0.2", "01")
        line = dump.process.communicate(timeout=GUARD)[0]
        self.assertRegex(line, r"^\(\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{6}\) 0.10   -> 0.2    normal message \[1\] 01\n$")
        said = calendar.timegm(time.strptime(line[1:20], "%Y-%m-%d %H:%M:%S"))
        self.assertLessEqual(abs(said - before), 2 * GUARD)

    def test_log_names_the_bus_without_its_kind(self):
        self.assertEqual(
            self.shown("--log"),
            "(0000000000.000000) robot 1000400A#5A2D00\n"
            "(0000000000.000000) robot 123#R4\n"
            "(0000000000.000000) robot 1C00400A#11\n",
        )

    def test_json(self):
        self.assertEqual(
            self.shown("--json"),
            '{"type":"Roio","isBroadcast":false,"address":2,"subnet":0,"messageLength":3,'
            '"data":[90,45,0],"source":"0.10","timestamp":0}\n'
            '{"type":"CAN","kind":"standard-remote","id":291,"length":4,"data":[],"timestamp":0}\n'
            '{"type":"CAN","kind":"extended","id":469778442,"length":1,"data":[17],"timestamp":0}\n',
        )

    def test_no_foreign_hides_and_does_not_count_them(self):
        dump = self.dump("-n", "2", "--no-foreign", BUS)
        self.send(BUS, "0.2", "01")
        self.send(BUS, "-", stdin="(1.0) x 123#\n(1.0) x 1C00400A#11\n(1.0) x 1000400A#R\n")
        self.send(BUS, "0.2", "02")
        self.assertEqual(
            dump.result(),
            (0,
             "0.10   -> 0.2     normal  message  [1]  01\n"
             "0.10   -> 0.2     normal  message  [1]  02\n",
             ""),
        )

    def test_filters_let_through_what_they_say(self):
        # options, destination and data; the filter that wants just this one
        traffic = [
            ([], ["0.2", "01"], "to=0.2"),
            ([], ["0.*", "02"], "to=0.*"),
            (["--from", "0.3"], ["1.4", "03"], "from=0.3"),
            (["--urgent"], ["1.5", "04"], "urgent"),
            (["--class", "system"], ["1.6", "05"], "class=system"),
        ]
        for _, (_, data), word in traffic:
            with self.subTest(word):
                dump = self.dump("-n", "2", "--log", BUS, word, "or", "to=31.254")
                for options, message, _ in traffic:
                    self.send(*options, BUS, *message)
                self.send(BUS, "31.254", "FF")  # the last one
                status, out, err = dump.result()
                self.assertEqual((status, err), (0, ""))
                self.assertEqual([line[-2:] for line in out.splitlines()], [data, "FF"])


class SeveralTest(CliTest):
    def test_two_buses_have_a_column_for_them_and_a_filter_is_for_both(self):
        dump = self.dump("-n", "3", BUS, "local:arm", "to=0.any")
        self.assertEqual(dump.first, "roio-cli: local:robot, local:arm: listening\n")
        self.send("local:arm", "0.2", "01")
        self.send("local:arm", "1.2", "FF")
        self.send(BUS, "0.2", "02")
        self.send("local:arm", "0.2", "03")
        self.assertEqual(dump.result(), (
            0,
            "arm   0.10   -> 0.2     normal  message  [1]  01\n"
            "robot 0.10   -> 0.2     normal  message  [1]  02\n"
            "arm   0.10   -> 0.2     normal  message  [1]  03\n", ""))

    def test_every_form_names_the_bus(self):
        for options, pattern in (
            (["--log"], r"^\(\d+\.\d{6}\) arm 123#11$"),
            (["--json"], r'^{"type":"CAN",.*,"timestamp":\d+(\.\d+)?,"bus":"local:arm"}$'),
            (["--csv"], r"^\d+\.\d{6},local:arm,standard,0x123,"),
        ):
            with self.subTest(options):
                dump = self.dump("-n", "1", *options, "-b", BUS, "-b", "local:arm")
                self.send("local:arm", "123#11")
                out, _ = dump.process.communicate(timeout=GUARD)
                self.assertRegex(out.splitlines()[-1], pattern)

    def test_json_of_several_can_be_sent_again(self):
        dump = self.dump("-n", "2", "--json", BUS, "local:arm")
        self.send("local:arm", "123#11")
        self.send(BUS, "0.2", "01")
        out, _ = dump.process.communicate(timeout=GUARD)
        again = self.dump("-n", "2", "--log", BUS)
        self.assertEqual(self.run_cli("send", BUS, "-", stdin=out), (
            0, "", 'roio-cli: line 2: the log is of several interfaces, "local:arm" and "local:robot" among '
                   "them; the frames of all are sent to local:robot\n"))
        self.assertEqual([line.split()[2] for line in again.result()[1].splitlines()],
                         ["123#11", "1000400A#01"])

    def test_a_signal_ends_it_and_a_quiet_time(self):
        dump = self.dump(BUS, "local:arm")
        dump.signal(signal.SIGINT)
        self.assertEqual(dump.result(), (130, "", ""))
        self.assertEqual(self.run_cli("dump", "-T", "50", BUS, "local:arm"), (0, "", ""))

    def test_a_flood_of_both_is_whole_and_in_order(self):
        count = 3000
        dump = self.dump("-n", str(2 * count), "--log", BUS, "local:arm")
        lines = "".join(f"1000400A#{number:08X}\n" for number in range(count))
        senders = [subprocess.Popen([CLI, "send", bus, "-"], stdin=subprocess.PIPE, text=True)
                   for bus in (BUS, "local:arm")]
        for sender in senders:
            sender.stdin.write(lines)
            sender.stdin.close()
        for sender in senders:
            self.assertEqual(sender.wait(GUARD), 0)
        out, _ = dump.process.communicate(timeout=GUARD)
        shown = [line.split() for line in out.splitlines()]
        for name in ("robot", "arm"):
            self.assertEqual([frame for _, bus, frame in shown if bus == name], lines.split())


class EndTest(CliTest):
    def test_count_reached_is_success_and_the_rest_is_left(self):
        dump = self.dump("-n", "2", BUS)
        self.send("--count", "5", BUS, "0.2", "01")
        self.assertEqual(dump.result(), (0, "0.10   -> 0.2     normal  message  [1]  01\n" * 2, ""))
        self.assertEqual(dump.counts, "roio-cli: local:robot: 2 frames shown, 0 lost\n")

    def test_quiet_time_is_success(self):
        self.assertEqual(self.run_cli("dump", "-T", "50", BUS), (0, "", ""))

    def test_quiet_time_before_the_count_is_failure(self):
        self.assertEqual(
            self.run_cli("dump", "-n", "2", "-T", "50", BUS),
            (1, "", "roio-cli: local:robot: 0 of 2 frames came in time\n"),
        )

    def test_quiet_time_begins_again_with_each_frame(self):
        dump = self.dump("-T", "4000", BUS)
        self.send("--count", "3", "--interval", "2100", BUS, "0.2", "01")  # 4.2 s in all
        self.assertEqual(dump.result(), (0, "0.10   -> 0.2     normal  message  [1]  01\n" * 3, ""))

    def test_signals_end_it_cleanly(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            dump = self.dump("-n", "100", BUS)
            self.send(BUS, "0.2", "01")
            line = dump.line()
            dump.signal(number)
            self.assertEqual(dump.result(), (128 + number, "", ""))
            self.assertEqual(line, "0.10   -> 0.2     normal  message  [1]  01\n")

    def test_a_frame_is_shown_at_once_also_into_a_pipe(self):
        dump = self.dump(BUS)
        for _ in range(3):
            self.send(BUS, "0.2", "01")
            self.assertTrue(select.select([dump.process.stdout], [], [], GUARD)[0])
            self.assertEqual(dump.line(), "0.10   -> 0.2     normal  message  [1]  01\n")

    def test_a_reader_that_goes_away_ends_it_without_a_word(self):
        for traffic in (True, False):
            with self.subTest(traffic=traffic):
                dump = self.dump(BUS)
                dump.process.stdout.close()
                if traffic:
                    self.send(BUS, "0.2", "01")
                self.assertEqual(dump.process.wait(GUARD), 128 + signal.SIGPIPE)
                self.assertEqual(dump.process.stderr.read(), "")
                dump.process.stdout = None

    def test_an_output_that_cannot_be_written_is_a_failure(self):
        with open("/dev/full", "w") as full:
            dump = self.dump(BUS, stdout=full)
            self.send(BUS, "0.2", "01")
            self.assertEqual(
                dump.result(), (1, "", "roio-cli: standard output: No space left on device\n")
            )

    def test_the_lines_of_a_flood_are_whole_when_a_signal_comes(self):
        with open(self.path("log"), "w") as log:
            dump = self.dump("--log", BUS, stdout=log)
            sender = subprocess.Popen(
                [CLI, "send", "--count", "0", BUS, "0.2", "0102030405060708"],
                stderr=subprocess.DEVNULL,
            )
            while os.path.getsize(self.path("log")) < 100000:
                time.sleep(0.01)
            dump.signal(signal.SIGTERM)
            self.assertEqual(dump.process.wait(GUARD), 128 + signal.SIGTERM)
            sender.terminate()
            sender.wait(GUARD)
        with open(self.path("log")) as log:
            for line in log:
                self.assertRegex(line, r"^\(\d{10}\.\d{6}\) robot 1000400A#0102030405060708\n$")


class HubTest(CliTest):
    def test_a_hub_that_is_killed_goes_unnoticed(self):
        hub = self.dump(BUS)
        other = self.dump("-n", "2", BUS)
        self.send(BUS, "0.2", "01")
        hub.process.kill()
        hub.process.wait(GUARD)
        self.send(BUS, "0.2", "02")
        self.assertEqual(
            other.result(),
            (0,
             "0.10   -> 0.2     normal  message  [1]  01\n"
             "0.10   -> 0.2     normal  message  [1]  02\n",
             ""),
        )


class ColourTest(CliTest):
    def on_a_terminal(self, *options, **variables):
        """What dump writes to a terminal of one urgent message."""
        main_end, terminal = pty.openpty()
        env = {k: v for k, v in os.environ.items() if k not in ("NO_COLOR", "TERM")}
        env.update({"TERM": "xterm"}, **variables)
        dump = self.dump("-n", "1", *options, BUS, env=env, stdout=terminal)
        self.send("--urgent", BUS, "0.2", "01")
        self.assertEqual(dump.process.wait(GUARD), 0)
        os.close(terminal)
        text = os.read(main_end, 1000).decode()
        os.close(main_end)
        return text

    def test_only_on_a_terminal_that_wants_it(self):
        plain = "0.10   -> 0.2     urgent  message  [1]  01\r\n"
        self.assertEqual(
            self.on_a_terminal(), "\033[1;33m0.10   -> 0.2     urgent  message  [1]  01\033[0m\r\n"
        )
        self.assertEqual(self.on_a_terminal(NO_COLOR="1"), plain)
        self.assertEqual(self.on_a_terminal(TERM="dumb"), plain)
        self.assertNotEqual(self.on_a_terminal(NO_COLOR=""), plain)  # no-color.org: when not empty
        self.assertEqual(
            self.on_a_terminal("-c"),
            "\033[33m\033[1m0.10   -> 0.2     urgent  message  [1]  01\033[0m\r\n")
        self.assertEqual(self.on_a_terminal("-c", NO_COLOR="1"), plain)

    def test_a_capture_is_not_for_a_terminal(self):
        main_end, terminal = pty.openpty()
        done = subprocess.run([CLI, "dump", "--pcap", BUS], stdout=terminal, stderr=subprocess.PIPE,
                              text=True, timeout=GUARD)
        os.close(terminal)
        os.close(main_end)
        self.assertEqual((done.returncode, done.stderr), (
            2, "roio-cli: --pcap: expected into a file or a pipe, as what it writes is no text\n"))

    def test_on_no_terminal_there_is_none(self):
        dump = self.dump("-n", "1", "-c", BUS)
        self.send("--urgent", BUS, "0.2", "01")
        self.assertEqual(dump.result(), (0, "0.10   -> 0.2     urgent  message  [1]  01\n", ""))


if __name__ == "__main__":
    main()
