#!/usr/bin/env python3
"""Wrong command lines: each is one line on standard error that says what was expected, and exit 2."""

import os
import shlex

from driver import CliTest, main

SEND_HELP = "; `roio-cli send --help` shows how"
DUMP_HELP = "; `roio-cli dump --help` shows how"
SHOW_HELP = "; `roio-cli bridge show --help` shows how"
SET_HELP = "; `roio-cli bridge set --help` shows how"
EMPTY = "; without DATA the message is empty"
WORDS = ("expected to=SUBNET.NODE, from=SUBNET.NODE, urgent, normal, class=message|system|stream, "
         "ID:MASK, ID~MASK or the word or")

COMMANDS = ("send, ask, dump, top, record, play, gen, buses, hub, "
            "attach, bridge, kind, robot or help")

# command line, the line on standard error
WRONG = [
    ("", f"expected a command: {COMMANDS}; `roio-cli --help` shows how"),
    ("snd local:x", f'unknown command "snd": expected {COMMANDS}; `roio-cli --help` shows how'),
    ("--foo", 'unknown option "--foo"; `roio-cli --help` shows how'),
    # send: what is missing
    ("send", "expected BUS, DEST and DATA" + SEND_HELP),
    ("send local:x", "expected DEST after BUS: a place, SUBNET.NODE, SUBNET.*, ID#DATA or -" + SEND_HELP),
    ("send local:x 0.2 --count", "--count: expected a value after it"),
    # send: the bus
    ("send local: 0.2",
     'bus "local:": a bus name of 0 bytes; expected 1..64, such as robot'),
    ("send local:x?bitrate=999 0.2",
     'bus "local:x?bitrate=999": bitrate "999"; expected 1000..1000000 (bit/s), without leading '
     "zeros"),
    ("send can0,123:7FF 0.2",
     'bus "can0,123:7FF": unknown kind of bus "can0,123"; expected an interface such as can0, '
     "local:NAME or serial:DEVICE"),
    # send: addresses
    ("send local:x 2 01",
     'address "2": no dot; expected SUBNET.NODE, such as 0.2'),
    ("send local:x 0.256 01",
     'address "0.256": node 256 is out of range; expected 0..254, or * for a broadcast'),
    ("send local:x 32.0 01", 'address "32.0": subnet 32 is out of range; expected 0..31'),
    ("send --from 0.* local:x 0.2 01",
     '--from: address "0.*": a broadcast is no address of a node\'s own; expected node 0..254'),
    # send: data
    ("send local:x 0.2 5A2", 'data "5A2": odd number of hex digits; expected two per byte'),
    ("send local:x 0.2 5G", 'data "5G": "G" is no hex digit'),
    ("send local:x 0.2 010203040506070809",
     'data "010203040506070809": 9 bytes; a frame carries at most 8'),
    ("send local:x 0.2 5 A", 'data "5 A": odd number of hex digits; expected two per byte'),
    ("send local:x 0.2 01 02 03 04 05 06 07 08 09",
     'data "01 02 03 04 05 06 07 08 09": 9 bytes; a frame carries at most 8'),
    ("send local:x 0.2 -- -5", 'data "-5": "-" is no hex digit'),
    ("send local:x 0.2 ''",
     'DATA: expected hexadecimal digits such as 5A2D00, found ""' + EMPTY),
    ("send local:x 0.2 5A ''",
     'DATA: expected hexadecimal digits such as 5A2D00, found ""' + EMPTY),
    ("send local:x 0.2 --dec", "--dec: expected 1 to 8 numbers 0..255 after DEST" + EMPTY),
    ("send local:x 0.2 --dec ''", 'DATA with --dec: expected a whole number 0..255, found ""'),
    # send: frames as cansend takes them
    ("send local:x 123##1DEAD",
     'frame "123##1DEAD": a CAN FD frame ("##"); only classic CAN frames are taken'),
    ("send local:x 123#DEA", 'frame "123#DEA": odd number of hex digits; expected two per byte'),
    ("send local:x 800#", 'frame "800#": identifier 800 is out of range; expected 000..7FF'),
    ("send local:x 20000004#00",
     'frame "20000004#00": a controller\'s error report; expected a frame to send'),
    ("send local:x 123#DE AD", "DATA: expected none after ID#DATA, as the frame has its own"),
    ("send --from 0.3 local:x 123#DE",
     "--from: expected without ID#DATA, as the frame says its own"),
    ("send --urgent local:x 123#DE",
     "--urgent: expected without ID#DATA, as the frame says its own"),
    # send: --wait
    ("send --wait can0 0.2",
     "--wait: expected with local:NAME alone; on can0 nobody can tell who listens"),
    ("send --wait=0 local:x 0.2", '--wait: expected a whole number 1..86400000, found "0"'),
    ("send --wait=soon local:x 0.2", '--wait: expected a whole number 1..86400000, found "soon"'),
    ("send local:x 0.2 --dec 256",
     'DATA with --dec: expected a whole number 0..255, found "256"'),
    ("send local:x 0.2 --dec 5A",
     'DATA with --dec: expected a whole number 0..255, found "5A"'),
    ("send local:x 0.2 --dec 1 2 3 4 5 6 7 8 9", "DATA: expected at most 8 bytes, found 9"),
    # send: options
    ("send --form 0.3 local:x 0.2", 'unknown option "--form"' + SEND_HELP),
    ("send --class fast local:x 0.2",
     '--class: expected message, system or stream, found "fast"'),
    ("send --class reserved local:x 0.2",
     '--class: expected message, system or stream, found "reserved"'),
    ("send --count ten local:x 0.2",
     '--count: expected a whole number 0..4294967295, found "ten"'),
    ("send --count 4294967296 local:x 0.2",
     '--count: expected a whole number 0..4294967295, found "4294967296"'),
    ("send --count 1 --count 2 local:x 0.2", "--count: given twice; expected once"),
    ("send --count local:x 0.2",
     '--count: expected a whole number 0..4294967295, found "local:x"'),
    ("send --from local:x 0.2",
     '--from: address "local:x": no dot; expected SUBNET.NODE, such as 0.2'),
    ("send --dec=5 local:x 0.2", "--dec: expected no value after it"),
    ("send --interval 10 local:x 0.2",
     "--interval: expected with --count N (0: until interrupted)"),
    ("send --timeout 0 local:x 0.2",
     '--timeout: expected a whole number 1..86400000, found "0"'),
    # send: lines from standard input say everything themselves
    ("send local:x - 01",
     "DATA: expected none after DEST -, as each line of the input has its own"),
    ("send --urgent local:x -",
     "--urgent: expected without DEST -, as each line of the input says its own"),
    ("send --class system local:x -",
     "--class: expected without DEST -, as each line of the input says its own"),
    ("send --count 2 local:x -",
     "--count: expected without DEST -, as each line of the input says its own"),
    ("send --dec local:x -",
     "--dec: expected without DEST -, as each line of the input says its own"),
    # dump
    ("dump", "expected BUS" + DUMP_HELP),
    ("dump --colour local:x", 'unknown option "--colour"' + DUMP_HELP),
    ("dump -n", "-n: expected a value after it"),
    ("dump -n 1 -n 2 local:x", "-n: given twice; expected once"),
    ("dump -t local:x", '-t: expected a (absolute), A (with date), d (delta) or z (zero), found "local:x"'),
    ("dump -n local:x", '-n: expected a whole number 1..4294967295, found "local:x"'),
    ("dump --json=yes local:x", "--json: expected no value after it"),
    ("dump /dev/ttyACM0",
     'bus "/dev/ttyACM0": a path is no interface; expected serial:/dev/ttyACM0 for the bridge on that '
     "serial port"),
    ("dump -n 0 local:x", '-n: expected a whole number 1..4294967295, found "0"'),
    ("dump -T soon local:x", '-T: expected a whole number 1..86400000, found "soon"'),
    ("dump -t b local:x", '-t: expected a (absolute), A (with date), d (delta) or z (zero), found "b"'),
    ("dump -t a --log local:x",
     "-t: expected without --log, which has a time of its own"),
    ("dump -c --csv local:x", "-c: expected without --csv, which has no colours"),
    ("dump --json --log local:x", "expected either --log or --json, not both"),
    ("dump --pcap --csv local:x", "expected either --csv or --pcap, not both"),
    ("dump --pcap local:x local:y",
     "--pcap: expected one BUS, as its form has no place for a bus's name"),
    ("dump local:x local:y local:x", 'BUS "local:x": given twice; expected once'),
    ("dump local:x local:y local:x?bitrate=500000",
     'BUS "local:x?bitrate=500000": the same as "local:x"; expected once'),
    ("record -b can0 socketcan:can0", 'BUS "socketcan:can0": the same as "can0"; expected once'),
    ("dump -b", "-b: expected a value after it"),
    ("dump -b local:x urgnet", 'bad filter "urgnet": ' + WORDS),
    ("dump local:x can0 ur/gent0", 'bad filter "ur/gent0": ' + WORDS),
    # dump: filters
    ("dump local:x urgnet", 'bad filter "urgnet": ' + WORDS),
    ("dump local:x to=0.2,urgent",
     'bad filter "to=0.2,urgent": address "0.2,urgent": node "2,urgent" is not a number; expected '
     "0..254, or * for a broadcast"),
    ("dump local:x to=32.1",
     'bad filter "to=32.1": address "32.1": subnet 32 is out of range; expected 0..31'),
    ("dump local:x class=fast",
     'bad filter "class=fast": class "fast": expected message, system, stream or reserved'),
    ("dump local:x 123:XYZ",
     'bad filter "123:XYZ": expected an identifier and a mask of 1 to 8 hexadecimal digits each, '
     "such as 123:7FF or 1004A00A~1FFFFFFF"),
    ("dump local:x 1234:7FF",
     'bad filter "1234:7FF": identifier 1234 is out of range; expected 0..7FF, or 8 digits '
     "(extended)"),
    ("dump local:x from=0.*",
     'bad filter "from=0.*": "0.*" is the broadcast address, which nobody sends from; expected 0.any '
     "for any node of the subnet"),
    ("dump local:x or", 'bad filter "or": expected a filter on either side of it'),
    ("dump local:x urgent 1:C00007FF",
     'no frame can satisfy these filters together; put "or" between choices'),
    # ask
    ("ask", "expected BUS, DEST and DATA; `roio-cli ask --help` shows how"),
    ("ask local:x", "expected DEST after BUS: a place, SUBNET.NODE or SUBNET.*; `roio-cli ask --help` shows how"),
    ("ask local:x -", 'address "-": no dot; expected SUBNET.NODE, such as 0.2'),
    ("ask local:x 123#11", 'address "123#11": no dot; expected SUBNET.NODE, such as 0.2'),
    ("ask local:x 0.2 5A2", 'data "5A2": odd number of hex digits; expected two per byte'),
    ("ask --dec local:x 0.2 256", 'DATA with --dec: expected a whole number 0..255, found "256"'),
    ("ask --from 0.* local:x 0.2",
     '--from: address "0.*": a broadcast is no address of a node\'s own; expected node 0..254'),
    ("ask --timeout 0 local:x 0.2", '--timeout: expected a whole number 1..86400000, found "0"'),
    ("ask --class fast local:x 0.2", '--class: expected message, system or stream, found "fast"'),
    # top
    ("top", "expected BUS; `roio-cli top --help` shows how"),
    ("top --interval 9 local:x", '--interval: expected a whole number 10..86400000, found "9"'),
    ("top --bitrate 999 local:x", '--bitrate: expected a whole number 1000..1000000, found "999"'),
    ("top -n 0 local:x", '-n: expected a whole number 1..4294967295, found "0"'),
    ("top local:x to=0.2", 'expected no more words, found "to=0.2"; `roio-cli top --help` shows how'),
    # gen
    ("gen", "expected BUS; `roio-cli gen --help` shows how"),
    ("gen --size 3 local:x", "--size: 3 bytes are too short for a number; expected 4..8"),
    ("gen --size 0-8 local:x", "--size: 0 bytes are too short for a number; expected 4..8"),
    ("gen --size 9 local:x", '--size: expected a whole number 0..8, found "9"'),
    ("gen --size 8-4 local:x", '--size: expected the shorter first, found "8-4"'),
    ("gen --load 101% local:x", '--load: expected a whole number 1..100, found "101"'),
    ("gen --load 0 local:x", '--load: expected a whole number 1..100, found "0"'),
    ("gen --load 80% local:x", "--load: the bit rate of local:x is not known; expected --bitrate BPS"),
    ("gen --load 80% --rate 5 local:x", "expected either --load or --rate, not both"),
    ("gen --rate 0 local:x", '--rate: expected a whole number 1..1000000, found "0"'),
    ("gen --id 128 local:x", '--id: expected a whole number 0..127, found "128"'),
    ("gen --seed 4294967296 local:x", '--seed: expected a whole number 0..4294967295, found "4294967296"'),
    ("gen --from all local:x", '--from: address "all": no dot; expected SUBNET.NODE, such as 0.2'),
    ("gen --to 32.1 local:x", '--to: address "32.1": subnet 32 is out of range; expected 0..31'),
    ("gen -T 5 local:x", "-T: expected with --check alone"),
    ("gen -v local:x", "--verbose: expected with --check alone"),
    ("gen --check --rate 5 local:x", "--rate: expected without --check, which takes what comes"),
    ("gen --check --urgent local:x", "--urgent: expected without --check, which takes what comes"),
    # attach
    ("attach", "expected two buses; `roio-cli attach --help` shows how"),
    ("attach local:x", "expected another BUS after the first; `roio-cli attach --help` shows how"),
    ("attach local:x local:x", "local:x and local:x are one bus; expected two"),
    ("attach local:x local:", 'bus "local:": a bus name of 0 bytes; expected 1..64, such as robot'),
    ("attach local:x local:y local:z",
     'expected no more words, found "local:z"; `roio-cli attach --help` shows how'),
    # record
    ("record", "expected BUS; `roio-cli record --help` shows how"),
    ("record -o local:x", "expected BUS; `roio-cli record --help` shows how"),
    ("record -o - local:x",
     '-o: expected the name of a file, found "-"; `roio-cli dump --log` writes to standard output'),
    ("record --json local:x", 'unknown option "--json"; `roio-cli record --help` shows how'),
    ("record --csv --pcap local:x", "expected either --csv or --pcap, not both"),
    ("record -o a.pcap local:x local:y",
     "--pcap: expected one BUS, as its form has no place for a bus's name"),
    ("record -n 0 local:x", '-n: expected a whole number 1..4294967295, found "0"'),
    ("record local:x urgnet", 'bad filter "urgnet": ' + WORDS),
    # play
    ("play", "expected FILE and BUS; `roio-cli play --help` shows how"),
    ("play a.log", "expected BUS after FILE, or BUS=NAME for an interface of the log; "
                   "`roio-cli play --help` shows how"),
    ("play --speed fast a.log local:x", '--speed: expected a number 0.001..1000 or max, found "fast"'),
    ("play --speed 0 a.log local:x", '--speed: expected a number 0.001..1000 or max, found "0"'),
    ("play --speed nan a.log local:x", '--speed: expected a number 0.001..1000 or max, found "nan"'),
    ("play --speed 1e2 a.log local:x", '--speed: expected a number 0.001..1000 or max, found "1e2"'),
    ("play --gap -1 a.log local:x", '--gap: expected a whole number 0..86400000, found "-1"'),
    ("play --loop=x a.log local:x", '--loop: expected a whole number 0..4294967295, found "x"'),
    ("play --from soon a.log local:x",
     "--from: expected a time as the log has it, such as 1436509052.25, or +12.5 since its first frame, "
     'found "soon"'),
    ("play --loop - local:x", "--loop: expected a file, which can be read again, not standard input"),
    ("play a.log local:x local:y",
     'BUS "local:y": expected one BUS, or BUS=NAME for each interface of the log'),
    ("play --wait a.log can0=can1",
     "--wait: expected with local:NAME alone; on can0 nobody can tell who listens"),
    # help
    ("help snd",
     f'unknown command "snd": expected {COMMANDS}; `roio-cli --help` shows how'),
    ("help bridge shw",
     'unknown command "shw": expected show, set, identify or attach; `roio-cli bridge --help` shows '
     "how"),
    # kind
    ("kind", "expected a command: header, js or md; `roio-cli kind --help` shows how"),
    ("kind hdr x.kind.json",
     'unknown command "hdr": expected header, js or md; `roio-cli kind --help` shows how'),
    ("help kind hdr",
     'unknown command "hdr": expected header, js or md; `roio-cli kind --help` shows how'),
    ("kind header",
     "expected FILE, such as servo-arm.kind.json; `roio-cli kind header --help` shows how"),
    ("kind js a.kind.json b.kind.json",
     'expected no more words, found "b.kind.json"; `roio-cli kind js --help` shows how'),
    ("kind md --types a.kind.json", 'unknown option "--types"; `roio-cli kind md --help` shows how'),
    ("kind md --check a.kind.json", "--check: expected with -o OUT, the file to look at"),
    ("kind md -o", "--output: expected a value after it"),
    ("kind md -o '' a.kind.json", '-o: expected the name of a file, found ""'),
    ("kind md -o a -o b a.kind.json", "--output: given twice; expected once"),
    # robot
    ("robot", "expected a command: dbc or check; `roio-cli robot --help` shows how"),
    ("robot chk robot.json",
     'unknown command "chk": expected dbc or check; `roio-cli robot --help` shows how'),
    ("robot check", "expected FILE, such as robot.json; `roio-cli robot check --help` shows how"),
    ("robot check -o out robot.json",
     'unknown option "-o"; `roio-cli robot check --help` shows how'),
    ("robot dbc --check robot.json", "--check: expected with -o OUT, the file to look at"),
    # buses
    ("buses -- can0", 'expected no more words, found "can0"; `roio-cli buses --help` shows how'),
    ("buses can0", 'expected no more words, found "can0"; `roio-cli buses --help` shows how'),
    ("buses -v", 'unknown option "-v"; `roio-cli buses --help` shows how'),
    # bridge
    ("bridge",
     "expected a command: show, set, identify or attach; `roio-cli bridge --help` shows how"),
    ("bridge shw /dev/ttyACM0",
     'unknown command "shw": expected show, set, identify or attach; `roio-cli bridge --help` shows '
     "how"),
    ("bridge --json", 'unknown option "--json"; `roio-cli bridge --help` shows how'),
    # bridge: the port
    ("bridge show", "expected PORT" + SHOW_HELP),
    ("bridge show --json", "expected PORT" + SHOW_HELP),
    ("bridge show --jsn auto", 'unknown option "--jsn"' + SHOW_HELP),
    ("bridge show auto /dev/ttyACM0", 'expected no more words, found "/dev/ttyACM0"' + SHOW_HELP),
    ("bridge show can0",
     'PORT: expected a serial port such as /dev/ttyACM0, or auto, found "can0"'),
    ("bridge show local:x",
     'PORT: expected a serial port such as /dev/ttyACM0, or auto, found "local:x"'),
    ("bridge show serial:",
     'bus "serial:": no device; expected one such as /dev/ttyACM0, or auto'),
    ("bridge show serial:/dev/ttyACM0?baud=9600",
     'bus "serial:/dev/ttyACM0?baud=9600": baud "9600"; expected 115200, 250000, 500000, 1000000 or '
     "2000000"),
    ("bridge show /dev/null/none",
     "serial:/dev/null/none: no such serial port; `ls /dev/ttyACM* /dev/ttyUSB*` lists those that "
     "are plugged in, and serial:auto finds a bridge among them"),
    # bridge set
    ("bridge set auto", "expected --bitrate, --mode or --address" + SET_HELP),
    ("bridge show auto -- x", 'expected no more words, found "x"' + SHOW_HELP),
    ("bridge set --mode listen --mode normal auto", "--mode: given twice; expected once"),
    ("bridge set --bitrate auto",
     '--bitrate: expected a whole number 1000..1000000, found "auto"'),
    ("bridge set auto --bitrate", "--bitrate: expected a value after it"),
    ("bridge set auto --bitrate 999",
     '--bitrate: expected a whole number 1000..1000000, found "999"'),
    ("bridge set auto --bitrate 1000001",
     '--bitrate: expected a whole number 1000..1000000, found "1000001"'),
    ("bridge set auto --mode silent", '--mode: mode "silent": expected normal, listen or loopback'),
    ("bridge set auto --address 0.*",
     '--address: address "0.*": a broadcast is no address of a node\'s own; expected node 0..254'),
    ("bridge set auto --address any",
     '--address: address "any": no dot; expected SUBNET.NODE, such as 0.2'),
    # bridge identify
    ("bridge identify auto --seconds 256",
     '--seconds: expected a whole number 0..255, found "256"'),
    # bridge attach
    ("bridge attach", "expected PORT; `roio-cli bridge attach --help` shows how"),
    ("bridge attach auto",
     "expected BUS after PORT: an interface such as vcan0, or local:NAME; `roio-cli bridge attach "
     "--help` shows how"),
    ("bridge attach auto local:",
     'bus "local:": a bus name of 0 bytes; expected 1..64, such as robot'),
    ("bridge attach auto serial:/dev/ttyACM1",
     'BUS: expected an interface such as vcan0, or local:NAME, found "serial:/dev/ttyACM1"'),
    ("bridge attach auto local:x local:y",
     'expected no more words, found "local:y"; `roio-cli bridge attach --help` shows how'),
]


class WrongInputTest(CliTest):
    def test_each_is_one_line_and_exit_2(self):
        for command_line, expected in WRONG:
            with self.subTest(command_line):
                self.assertEqual(
                    self.run_cli(*shlex.split(command_line)), (2, "", "roio-cli: " + expected + "\n")
                )

    def test_an_interface_that_is_not_there(self):
        status, out, err = self.run_cli("dump", "nosuch0")
        self.assertEqual((status, out), (2, ""))
        # Which of the two, the kernel of this machine decides.
        self.assertRegex(err, r"^roio-cli: nosuch0 \(did you mean local:nosuch0\?\): (no such network interface|this kernel has no "
                              r"CAN); .*local:NAME.*\n$")

    def test_a_bus_at_another_bit_rate(self):
        self.dump("local:paced?bitrate=500000")
        status, out, err = self.run_cli("send", "local:paced?bitrate=250000", "0.2")
        self.assertEqual((status, out), (2, ""))
        self.assertEqual(
            err,
            "roio-cli: local:paced?bitrate=250000 (it runs at 500000 bit/s): not the pace of "
            "this bus; its name alone, without bitrate, joins it as it is\n",
        )


    def test_a_relative_folder_for_buses(self):
        for command in (["send", "local:x", "0.2"], ["dump", "local:x"]):
            self.assertEqual(
                self.run_cli(*command, env=dict(os.environ, ROIO_RUNTIME_DIR="buses")),
                (2, "", 'roio-cli: ROIO_RUNTIME_DIR "buses": expected a path that begins with /\n'))


class BusesTest(CliTest):
    """What cannot be looked at is told, and the others are listed all the same."""

    def test_a_folder_that_cannot_be_read(self):
        with open(self.path("file"), "w"):
            pass
        missing = self.path("ttyACM0")
        for folder, error in ((self.path("file"), f"{self.path('file')}: Not a directory"),
                              ("buses", 'ROIO_RUNTIME_DIR "buses": expected a path that begins with '
                                        "/")):
            with self.subTest(folder):
                env = dict(os.environ, ROIO_RUNTIME_DIR=folder, ROIO_SERIAL_PORTS=missing)
                status, out, err = self.run_cli("buses", env=env)
                self.assertEqual(status, 1)
                self.assertIn(f"serial:{missing}  no bridge: no such serial port\n", out)
                self.assertEqual(err, f"roio-cli: local buses: {error}\n")

    def test_ports_that_are_named_wrongly(self):
        self.dump("local:robot")
        env = dict(os.environ, ROIO_SERIAL_PORTS="ttyACM0")
        status, out, err = self.run_cli("buses", env=env)
        self.assertEqual((status, err), (
            1, 'roio-cli: serial ports: ROIO_SERIAL_PORTS "ttyACM0": expected a path that begins with '
               "/\n"))
        self.assertIn("local:robot  local bus\n", out)


class InformationTest(CliTest):
    def test_version(self):
        status, out, err = self.run_cli("--version")
        self.assertEqual((status, err), (0, ""))
        self.assertRegex(out, r"^roio-cli \d+\.\d+\.\d+\n$")

    def test_help_goes_to_standard_output_and_has_examples(self):
        for command in ([], ["send"], ["ask"], ["dump"], ["top"], ["record"], ["play"], ["gen"], ["buses"],
                        ["attach"], ["bridge"], ["bridge", "show"], ["bridge", "set"], ["bridge", "identify"],
                        ["bridge", "attach"], ["kind"], ["kind", "header"], ["kind", "js"], ["kind", "md"],
                        ["robot"], ["robot", "dbc"], ["robot", "check"]):
            for option in ("--help", "-h"):
                status, out, err = self.run_cli(*command, option)
                self.assertEqual((status, err), (0, ""))
                self.assertIn("Usage: roio-cli " + " ".join(command), out)
                self.assertIn("Examples:\n  roio-cli ", out)
                self.assertLessEqual(max(map(len, out.splitlines())), 80)


    def test_help_is_a_command_too(self):
        for command in ([], ["send"], ["dump"], ["record"], ["play"], ["buses"], ["bridge"], ["bridge", "set"],
                        ["kind"], ["robot", "dbc"]):
            self.assertEqual(self.run_cli("help", *command), self.run_cli(*command, "--help"))


if __name__ == "__main__":
    main()
