#!/usr/bin/env python3
"""`roio-cli top`: on a terminal (tmux's), of several sizes, and its endings; into a pipe; exact counts."""

import json
import os
import pty
import re
import signal
import subprocess

from driver import CLI, GUARD, catches, main, wait_until
from live_driver import LiveTest, Screen

BUS = "local:robot"


class TopTest(LiveTest):
    def screen(self, *arguments, after="", **options):
        """A terminal with top, which is there already."""
        command = f"{CLI} top {' '.join(arguments or (BUS,))}{after}"
        screen = Screen(self, command, ROIO_RUNTIME_DIR=os.environ["ROIO_RUNTIME_DIR"], **options)
        screen.wait_for("nothing heard yet")
        return screen


class ScreenTest(TopTest):
    def test_80_by_24(self):
        screen = self.screen("'local:robot?bitrate=500000'")
        self.send(BUS, "0.2", "5A2D00")
        self.send("--urgent", "--from", "0.3", BUS, "0.*", "01")
        self.send(BUS, "123#R4")
        lines = screen.wait_for("remote request")
        self.assertEqual(len(lines), 24)
        self.assertEqual(lines[0], "local:robot  error-active  500000 bit/s")
        self.assertRegex(lines[1], r"^load +\d+\.\d %, peak +\d+\.\d %, \d+ frames/s, \d+ bit/s$")
        self.assertEqual(lines[2], "3 frames, 0 lost, 0 errors, 0 times bus-off, 0 outages")
        self.assertEqual(lines[3], "source    to      prio    class    msg  rate/s     age  value")
        age = r" +\d+(\.\d)? s  "
        self.assertRegex(lines[4], r"^0\.3    -> 0\.\*     urgent  message  \[1\]       -" + age + "01$")
        self.assertRegex(lines[5],
                         r"^0\.10   -> 0\.2     normal  message  \[3\]       -" + age + "5A 2D 00$")
        self.assertRegex(lines[6],
                         r"^11-bit    123             foreign  \[4\]       -" + age + "remote request$")
        self.assertEqual(lines[23], "q quit  s sort: source  r reverse  p pause  c clear  h help")

    def test_40_by_10_and_other_sizes_while_it_runs(self):
        screen = self.screen(columns=40, lines=10)
        self.send(BUS, "0.2", "0102030405060708")
        lines = screen.wait_for("^0.10 ")
        self.assertEqual(len(lines), 10)
        self.assertRegex(lines[4], r"^0\.10   0\.2    \[8\] +- 01 02 03 04 \+$")
        screen.resize(120, 30)
        lines = screen.wait_for(" frames  rate/s ")
        self.assertRegex(lines[4], r"01 02 03 04 05 06 07 08$")
        self.assertRegex(lines[29], "^q quit .* h help$")
        screen.resize(20, 4)
        self.assertEqual(screen.wait_for("^0 frames/s")[0], "local:robot  error-a")

    def test_changes_are_marked_in_colours_and_without(self):
        for variables, marked in (({"NO_COLOR": "1"}, r"5A 2E\*00"), ({}, r"\x1b\[1m\x1b\[33m2E\*")):
            with self.subTest(variables):
                screen = self.screen(**variables)
                for data in ("5A2D00", "5A2E00"):
                    self.send(BUS, "0.2", data)
                text = "\n".join(screen.wait_for(marked, "-e"))
                self.assertEqual("\x1b[33m" in text, not variables)
                if variables:
                    self.assertNotIn("\x1b", text.replace("\x1b[39m", "").replace("\x1b[0m", ""))
                screen.close()

    def test_keys(self):
        screen = self.screen()
        for node in range(40):
            self.send("--from", f"0.{node}", BUS, f"1.{40 - node}", "01")
        screen.wait_for("rows 1-19 of 40")
        for key, first, last in (("End", 22, 40), ("Up", 21, 39), ("PPage", 2, 20), ("k", 1, 19),
                                 ("NPage", 20, 38), ("Home", 1, 19), ("j", 2, 20), ("g", 1, 19)):
            screen.keys(key)
            screen.wait_for(f"rows {first}-{last} of 40")
        screen.keys("s")
        self.assertIn("sort: destination", screen.wait_for(r"^0\.39   -> 1\.1 ")[23])
        screen.keys("r")
        screen.wait_for("^0.0    -> 1.40 ")
        screen.keys("h")
        screen.wait_for("^c +forget all rows and counts")
        screen.keys("h")
        screen.keys("p")
        screen.wait_for("PAUSED")
        self.send("--from", "0.99", BUS, "0.2", "01")
        screen.keys("p")
        screen.wait_for("41 frames")
        screen.keys("c")
        screen.wait_for("nothing heard yet")
        self.assertIn("0 frames, 0 lost", screen.lines()[2])


class EndTest(TopTest):
    # Says how it ended, and whether the terminal is as it was.
    AFTER = "; echo status $?; stty -g | cmp - {modes} && echo as before; read stay"

    def ended_screen(self, end):
        modes = self.path("modes")
        command = (f"trap : INT; stty -g > {modes}; echo hello; {CLI} top {BUS}" +
                   self.AFTER.format(modes=modes))
        screen = Screen(self, command, ROIO_RUNTIME_DIR=os.environ["ROIO_RUNTIME_DIR"])
        screen.wait_for("nothing heard yet")
        end(screen)
        lines = screen.wait_for("as before")
        screen.close()
        return lines

    def pid(self, screen):
        shell = screen.tmux("list-panes", "-F", "#{pane_pid}").strip()
        found = []

        def look():
            with open(f"/proc/{shell}/task/{shell}/children") as children:
                found[:] = children.read().split()
            return found

        wait_until(look)
        return int(found[0])

    def test_the_terminal_is_as_it_was_whatever_ended_it(self):
        for what, end, status in (
                ("q", lambda screen: screen.keys("q"), 0),
                ("Ctrl-C", lambda screen: screen.keys("C-c"), 130),
                # Of Ctrl-\, which the shell around it would not outlive.
                ("SIGQUIT", lambda screen: os.kill(self.pid(screen), signal.SIGQUIT), 131),
                ("SIGTERM", lambda screen: os.kill(self.pid(screen), signal.SIGTERM), 143),
                ("SIGHUP", lambda screen: os.kill(self.pid(screen), signal.SIGHUP), 129)):
            with self.subTest(what):
                lines = self.ended_screen(end)
                # What stood there before is there again, and nothing of top's.
                self.assertEqual([line for line in lines if line],
                                 ["hello", f"status {status}", "as before"])

    def test_a_terminal_that_goes_away_ends_it(self):
        screen = self.screen()
        pid = self.pid(screen)
        screen.close()
        wait_until(lambda: not os.path.exists(f"/proc/{pid}"))

    def test_a_terminal_that_goes_away_unsaid_ends_it(self):
        """No SIGHUP: another session than the terminal's."""
        main_end, terminal = pty.openpty()
        top = subprocess.Popen([CLI, "top", BUS], stdin=terminal, stdout=terminal,
                               stderr=subprocess.DEVNULL, env=dict(os.environ, TERM="xterm"))
        self.addCleanup(top.kill)
        os.close(terminal)
        text = b""
        while b"nothing heard yet" not in text:
            text += os.read(main_end, 4096)
        os.close(main_end)
        self.assertEqual(top.wait(GUARD), 129)

    def test_a_terminal_that_takes_nothing_holds_up_neither_frames_nor_the_end(self):
        main_end, terminal = pty.openpty()
        self.addCleanup(os.close, main_end)
        top = subprocess.Popen([CLI, "top", "--interval", "10", BUS], stdin=terminal, stdout=terminal,
                               stderr=subprocess.PIPE, text=True, env=dict(os.environ, TERM="xterm"))
        self.addCleanup(top.kill)
        os.close(terminal)
        self.assertEqual(self.run_cli("gen", "--rate", "2000", "--count", "4000", "--to", "random", BUS)[0], 0)
        top.send_signal(signal.SIGTERM)
        self.assertEqual(top.wait(GUARD), 143)
        self.assertEqual(top.stderr.read(), "")
        top.stderr.close()

    def test_ctrl_z_gives_the_terminal_back_and_fg_takes_it_again(self):
        screen = Screen(self, "env PS1='ready ' bash --norc --noprofile -i",
                        ROIO_RUNTIME_DIR=os.environ["ROIO_RUNTIME_DIR"])
        screen.wait_for("^ready")
        screen.keys(f"{CLI} top {BUS}", "Enter")
        screen.wait_for("nothing heard yet")
        screen.keys("C-z")
        screen.wait_for("Stopped")
        screen.keys("fg", "Enter")
        screen.wait_for("nothing heard yet")
        screen.keys("q")
        screen.wait_for("^ready *$")

    def test_a_bus_that_goes_away_is_told_and_q_still_quits(self):
        carrier = self.running("gen", "--check", "-v", BUS)
        screen = self.screen(after="; echo status $?; read stay")
        carrier.process.send_signal(signal.SIGSTOP)
        self.addCleanup(carrier.process.send_signal, signal.SIGCONT)
        screen.wait_for("^local:robot  down")
        screen.keys("q")
        screen.wait_for("status 0")


class LinesTest(TopTest):
    def top(self, *arguments):
        top = subprocess.Popen([CLI, "top", *arguments], stdout=subprocess.PIPE, text=True)

        def end():
            top.kill()
            top.communicate()

        self.addCleanup(end)
        return top

    def intervals(self, top):
        """Each interval's lines: the bus, and its rows."""
        rows = []
        for line in top.stdout:
            found = json.loads(line)
            if found["type"] == "bus" and rows:
                yield rows[0], rows[1:]
                rows = []
            rows.append(found)
        if rows:
            yield rows[0], rows[1:]

    def test_a_line_for_the_bus_and_one_for_each_row(self):
        top = self.top("--interval", "50", "--bitrate", "500000", BUS)
        self.send("--wait", BUS, "0.2", "5A2D00")
        self.send(BUS, "0.2", "5A2D01")
        self.send(BUS, "123#R4")
        for bus, rows in self.intervals(top):
            if bus["frames"] == 3:
                break
        self.assertEqual((bus["bus"], bus["state"], bus["bitrate"], bus["lost"]),
                         (BUS, "error-active", 500000, 0))
        self.assertEqual(len(rows), 2)
        row = dict(rows[0])
        for name in ("rate", "age", "bits", "changed"):
            del row[name]
        self.assertEqual(row, {
            "type": "row", "source": "0.10", "destination": "0.2", "priority": "normal",
            "class": "message", "length": 3, "data": [90, 45, 1], "frames": 2, "silent": False})
        self.assertEqual({name: rows[1][name] for name in ("id", "extended", "remote", "length", "data")},
                         {"id": 0x123, "extended": False, "remote": True, "length": 4, "data": []})

    def test_ends_after_so_many_intervals(self):
        status, out, err = self.run_cli("top", "-n", "3", "--interval", "10", BUS)
        self.assertEqual((status, err, out.count('{"type":"bus"')), (0, "", 3))

    def test_a_saturated_bus_is_counted_exactly(self):
        bus = "local:fast?bitrate=1000000"
        carrier = self.running("gen", "--check", "-v", bus)  # whoever ends, the bus stays
        top = self.top("--interval", "100", bus)
        wait_until(lambda: catches(top, signal.SIGTERM))
        sent = 12000
        status, _, err = self.run_cli("gen", "--load", "100%", "--count", str(sent), "--size", "random",
                                      "--to", "random", bus)
        self.assertEqual(status, 0, err)
        carrier_said = None
        for facts, rows in self.intervals(top):
            if facts["frames"] + facts["lost"] >= sent:
                break
        status, carrier_said, _ = carrier.end(signal.SIGINT)
        self.assertRegex(carrier_said, rf"^0\.10 #\d+: {sent} received, from number 0, 0 lost, ")
        self.assertEqual(facts["frames"] + facts["lost"], sent)
        self.assertEqual(sum(row["frames"] for row in rows) + facts["rowless"], facts["frames"])
        self.assertLessEqual(facts["peakLoad"], 1.005)

    def test_signals_and_readers_that_go_away(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            top = self.top("--interval", "10", BUS)
            top.stdout.readline()
            top.send_signal(number)
            self.assertEqual(top.wait(GUARD), 128 + number)
        top = self.top("--interval", "10", BUS)
        top.stdout.readline()
        top.stdout.close()
        self.assertEqual(top.wait(GUARD), 128 + signal.SIGPIPE)
        top.stdout = None

    def test_a_terminal_that_cannot_be_drawn_on(self):
        main_end, terminal = pty.openpty()
        self.addCleanup(os.close, main_end)
        done = subprocess.run([CLI, "top", BUS], stdout=terminal, stderr=subprocess.PIPE, text=True,
                              timeout=GUARD, env=dict(os.environ, TERM="dumb"))
        os.close(terminal)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"^roio-cli: this terminal cannot be drawn on .*--json.*\n$")


if __name__ == "__main__":
    main()
