#!/usr/bin/env python3
"""roio-cli with a robot file: names in place of addresses and bytes, and which file holds."""

import json
import os
import subprocess

from driver import CLI, GUARD, CliTest, main

KIND = {
    "roio": 1,
    "kind": "servo-arm",
    "hears": {
        "angles": {"fields": [
            {"name": "shoulder", "type": "u8", "unit": "deg", "maximum": 180},
            {"name": "elbow", "type": "u8", "unit": "deg", "maximum": 180},
        ]},
        "speed": {"fields": [{"name": "speed", "type": "i16", "unit": "m/s", "scale": "1/10"},
                             {"name": "gear", "type": "enum", "values": {"low": 0, "high": 1}}],
                  "tag": 7},
        "face": {"fields": [{"name": "mood", "type": "u8"}]},
        "refusals": {},
    },
    "says": {"refusals": {"fields": [{"name": "count", "type": "u32"}]}},
}
ROBOT = {
    "roio": 1,
    "name": "test robot",
    "bus": {"name": "local:robot"},
    "places": {
        "arm": {"address": "0.2", "kind": "servo-arm"},
        "pc": {"address": "0.10"},
    },
}


class NamesTest(CliTest):
    def setUp(self):
        super().setUp()
        self.robot = self.write("robot.json", ROBOT)
        self.write("servo-arm.kind.json", KIND)
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(self.folder)

    def write(self, name, content):
        path = self.path(name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w") as file:
            file.write(content if isinstance(content, str) else json.dumps(content))
        return path

    def sends(self, *words, env=None):
        """What reaches a listener, as bytes."""
        dump = self.dump("--robot", "none", "-n", "1", "local:robot")
        self.assertEqual(self.run_cli("send", *words, env=env), (0, "", ""), words)
        status, out, err = dump.result()
        self.assertEqual((status, err), (0, ""))
        return out.rstrip("\n")

    def refuses(self, *words, env=None):
        status, out, err = self.run_cli("send", *words, env=env)
        self.assertEqual((status, out), (2, ""), words)
        return err.rstrip("\n")

    def test_a_message_is_sent_by_its_names(self):
        for words, line in [
            ("arm angles shoulder=90 elbow=45", "0.10   -> 0.2     normal  message  [2]  5A 2D"),
            ("arm angles elbow=45 shoulder=90", "0.10   -> 0.2     normal  message  [2]  5A 2D"),
            ("local:robot arm angles shoulder=90 elbow=45",
             "0.10   -> 0.2     normal  message  [2]  5A 2D"),
            ("0.2 angles shoulder=90 elbow=45", "0.10   -> 0.2     normal  message  [2]  5A 2D"),
            ("--urgent arm speed speed=-0.3 gear=high",
             "0.10   -> 0.2     urgent  message  [4]  07 FF FD 01"),
            ("arm refusals", "0.10   -> 0.2     normal  message  [0]"),
            ("arm", "0.10   -> 0.2     normal  message  [0]"),
            ("--from arm pc refusals count=258", "0.2    -> 0.10    normal  message  [4]  00 00 01 02"),
            # Bytes are still bytes, but where they are a name.
            ("arm 5A2D", "0.10   -> 0.2     normal  message  [2]  5A 2D"),
            ("arm 5A 2D", "0.10   -> 0.2     normal  message  [2]  5A 2D"),
            ("arm --dec 90 45", "0.10   -> 0.2     normal  message  [2]  5A 2D"),
            ("arm face mood=3", "0.10   -> 0.2     normal  message  [1]  03"),
            ("arm FACE", "0.10   -> 0.2     normal  message  [2]  FA CE"),
            ("--class system arm face", "0.10   -> 0.2     normal  system   [2]  FA CE"),
            ("0.* face mood=3", "0.10   -> 0.*     normal  message  [1]  03"),
            ("1000400A#5A2D", "0.10   -> 0.2     normal  message  [2]  5A 2D"),
        ]:
            with self.subTest(words):
                self.assertEqual(self.sends(*words.split()), line.rstrip())

    def test_what_is_wrong_is_named(self):
        for words, error in [
            ("amr angles", 'roio-cli: "amr": no such place; did you mean "arm"?'),
            ("arm angels shoulder=1",
             'roio-cli: "angels": no such message to arm; did you mean "angles"?'),
            ("arm angles shoulder=181 elbow=0",
             "roio-cli: angles.shoulder: 181 deg; expected a number 0..180 deg"),
            ("arm angles shoulder=1",
             "roio-cli: angles.elbow: missing; expected a number 0..180 deg"),
            ("arm angles shoulder=1 elbow=2 wrist=3",
             'roio-cli: angles: no field "wrist"; it has shoulder, elbow'),
            ("arm angles shoulder=1 elbow=2 shoulder=1",
             "roio-cli: angles.shoulder: given twice; expected once"),
            ("arm angles shoulder=1 elbow",
             'roio-cli: angles: expected FIELD=VALUE, found "elbow"; it has shoulder, elbow'),
            ("arm speed speed=0.25 gear=low",
             "roio-cli: speed.speed: 0.25 m/s is between two steps; expected 0.2 or 0.3"),
            ("arm speed speed=1 gear=third",
             'roio-cli: speed.gear: "third"; expected one of low, high'),
            ("local:robot 0.300 01",
             'roio-cli: address "0.300": node 300 is out of range; expected 0..254, or * for a broadcast'),
            ("arm 5A2", 'roio-cli: data "5A2": odd number of hex digits; expected two per byte'),
            ("arm 5G", 'roio-cli: data "5G": "G" is no hex digit'),
            ("arm refusals 1",
             'roio-cli: refusals: expected FIELD=VALUE, found "1"; it has no fields'),
        ]:
            with self.subTest(words):
                said = self.refuses(*words.split())
                self.assertTrue(said.startswith(error), said)
                self.assertEqual(said.count("\n"), 0, said)

    def test_a_name_whose_bytes_mean_something_else_there(self):
        # "arm" says "state" in the one byte in which "leg" hears "go".
        byte = [{"name": "x", "type": "u8"}]
        self.write("legs.kind.json", {"roio": 1, "kind": "legs", "hears": {"go": {"fields": byte}},
                                      "says": {"state": {"fields": byte}}})
        places = {"leg": {"address": "0.3", "kind": "legs"}, "foot": {"address": "0.4", "kind": "legs"},
                  "pc": {"address": "0.10"}}
        self.write("robot.json", {**ROBOT, "places": places})
        self.assertEqual(self.sends("leg", "go", "x=1"), "0.10   -> 0.3     normal  message  [1]  01")
        self.assertEqual(self.run_cli("send", "--from", "foot", "leg", "go", "x=1"),
                         (2, "", "roio-cli: go: from foot these bytes are state\n"))
        # A line without "from" is looked up as from who sends it.
        line = '{"type":"Roio","to":"pc","message":"state","fields":{"x":2}}\n'
        dump = self.dump("--robot", "none", "-n", "1", "local:robot")
        self.assertEqual(self.run_cli("send", "--from", "foot", "-", stdin=line), (0, "", ""))
        self.assertEqual(dump.result()[1], "0.4    -> 0.10    normal  message  [1]  02\n")

    def test_which_file_holds(self):
        other = dict(ROBOT, places={"arm": {"address": "3.4"}})
        deep = self.path("a/b")
        os.makedirs(deep)
        named = self.write("other/named.json", other)
        line = "0.10   -> {:<6}  normal  message  [1]  01"
        os.chdir(deep)
        self.assertEqual(self.sends("arm", "01"), line.format("0.2"), "a folder above")
        environment = dict(os.environ, ROIO_ROBOT=named)
        self.assertEqual(self.sends("arm", "01", env=environment), line.format("3.4"), "ROIO_ROBOT")
        self.assertEqual(self.sends("--robot", self.robot, "arm", "01", env=environment),
                         line.format("0.2"), "--robot before that")
        self.assertIn("arm", self.refuses("--robot", "none", "local:robot", "arm", "01"))
        nothing = dict(os.environ, ROIO_ROBOT="")
        self.assertIn("arm", self.refuses("local:robot", "arm", "01", env=nothing))

    def test_a_file_that_is_not_ours_is_passed_over(self):
        self.write("sub/robot.json", {"name": "another program's"})
        os.chdir(self.path("sub"))
        self.assertEqual(self.sends("arm", "01"), "0.10   -> 0.2     normal  message  [1]  01")

    def test_a_broken_file_is_named(self):
        self.write("robot.json", dict(ROBOT, places={"arm": {"adress": "0.2"}}))
        said = self.refuses("local:robot", "0.2", "01")
        self.assertIn("robot.json:1: places.arm", said)
        self.assertIn("adress", said)
        self.assertEqual(self.sends("--robot", "none", "local:robot", "0.2", "01"),
                         "0.10   -> 0.2     normal  message  [1]  01")

    def test_dump_shows_names(self):
        dump = self.dump("-n", "9")
        for words in ["arm angles shoulder=90 elbow=45", "--urgent arm speed speed=-0.3 gear=high",
                      "arm 07000002", "0.2 B500", "arm refusals", "--from arm pc refusals count=258",
                      "0.* face mood=3", "0.77 0102", "123#1122"]:
            self.assertEqual(self.run_cli("send", *words.split()), (0, "", ""))
        self.assertEqual(dump.result(), (
            0,
            "pc     -> arm     normal  angles    shoulder=90 deg  elbow=45 deg\n"
            "pc     -> arm     urgent  speed     speed=-0.3 m/s  gear=high\n"
            "pc     -> arm     normal  speed     speed=0 m/s  gear=2 (no choice has it)\n"
            "pc     -> arm     normal  angles    shoulder=181 deg (expected 0..180)  elbow=0 deg\n"
            "pc     -> arm     normal  refusals\n"
            "arm    -> pc      normal  refusals  count=258\n"
            "pc     -> 0.*     normal  face      mood=3\n"
            "pc     -> 0.77    normal  message   [2]  01 02\n"
            "foreign  11-bit 123                 [2]  11 22\n",
            ""))

    def test_dump_shows_bytes_when_asked(self):
        dump = self.dump("-x", "-n", "1", "to=arm")
        self.send("arm", "angles", "shoulder=90", "elbow=45")
        self.assertEqual(dump.result()[1], "pc     -> arm     normal  message  [2]  5A 2D\n")

    def test_dump_filters_by_name(self):
        dump = self.dump("-n", "2", "from=arm", "or", "to=arm", "urgent")
        for words in ["arm 01", "--urgent arm 02", "pc 04", "--from arm pc 03"]:
            self.send(*words.split())
        self.assertEqual(dump.result()[1],
                         "pc     -> arm     urgent  face      mood=2\n"
                         "arm    -> pc      normal  message   [1]  03\n")

    def test_a_filter_of_no_place_is_refused(self):
        self.assertEqual(self.run_cli("dump", "to=amr"),
                         (2, "", 'roio-cli: to= "amr": no such place; did you mean "arm"?\n'))

    def test_dump_of_json_has_names_and_can_be_sent(self):
        dump = self.dump("--json", "-n", "2")
        self.send("arm", "speed", "speed=-0.3", "gear=high")
        self.send("arm", "refusals")
        lines = dump.result()[1].splitlines()
        self.assertEqual(
            lines[0],
            '{"type":"Roio","isBroadcast":false,"address":2,"subnet":0,"messageLength":4,'
            '"data":[7,255,253,1],"source":"0.10","timestamp":0,"from":"pc","to":"arm",'
            '"message":"speed","fields":{"speed":-0.3,"gear":"high"}}')
        self.assertIn('"message":"refusals","fields":{}', lines[1])
        again = self.dump("-n", "2")
        self.send("-", stdin="\n".join(lines) + "\n")
        self.assertEqual(again.result()[1],
                         "pc     -> arm     normal  speed     speed=-0.3 m/s  gear=high\n"
                         "pc     -> arm     normal  refusals\n")

    def start(self, *words):
        process = subprocess.Popen([CLI, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def test_top_has_names(self):
        top = self.start("top", "-n", "1", "--interval", "1000")
        self.send("--wait", "arm", "speed", "speed=-0.3", "gear=high")
        out, err = top.communicate(timeout=GUARD)
        self.assertEqual(err, "")
        rows = [json.loads(line) for line in out.splitlines()]
        self.assertEqual(
            [(row["from"], row["to"], row["message"], row["fields"]) for row in rows if row["type"] == "row"],
            [("pc", "arm", "speed", {"speed": -0.3, "gear": "high"})])

    def test_gen_takes_places_and_the_robots_bus(self):
        check = self.start("gen", "--check", "-v", "--count", "3")
        self.assertEqual(check.stderr.readline(), "roio-cli: local:robot: listening\n")
        dump = self.dump("-n", "1", "-x", "local:robot")
        self.assertEqual(self.run_cli("gen", "--count", "3", "--id", "7", "--from", "arm", "--to", "pc")[0], 0)
        self.assertTrue(dump.result()[1].startswith("arm    -> pc "))
        self.assertEqual(check.communicate(timeout=GUARD)[0],
                         "0.2 #7: 3 received, from number 0, 0 lost, 0 doubled, 0 out of order\n")
        self.assertEqual(self.run_cli("gen", "--from", "hand")[0], 2)

    def test_ask_has_names(self):
        dump = self.dump("-n", "1", "to=arm")
        ask = self.start("ask", "--timeout", "60000", "arm", "refusals")
        self.assertEqual(dump.result()[1], "pc     -> arm     normal  refusals\n")
        self.send("--from", "arm", "pc", "refusals", "count=258")
        self.assertEqual(ask.communicate(timeout=GUARD)[0], "arm    -> pc      normal  refusals  count=258\n")
        self.assertRegex(self.run_cli("ask", "--timeout", "1", "arm", "refusals")[2],
                         "^roio-cli: local:robot: no answer from arm within 1 ms")

    def test_lines_of_json_have_names(self):
        dump = self.dump("--robot", "none", "-n", "3", "local:robot")
        lines = [
            {"type": "Roio", "to": "arm", "message": "angles", "fields": {"shoulder": 90, "elbow": 45}},
            {"type": "Roio", "from": "arm", "to": "pc", "message": "refusals", "fields": {"count": 1},
             "priority": "urgent"},
            {"type": "Roio", "isBroadcast": False, "address": 2, "subnet": 0, "messageLength": 1,
             "data": [1], "to": "arm", "message": "face", "fields": {"mood": 1}},
        ]
        self.assertEqual(
            self.run_cli("send", "-", stdin="".join(json.dumps(line) + "\n" for line in lines)),
            (0, "", ""))
        self.assertEqual(dump.result()[1],
                         "0.10   -> 0.2     normal  message  [2]  5A 2D\n"
                         "0.2    -> 0.10    urgent  message  [4]  00 00 00 01\n"
                         "0.10   -> 0.2     normal  message  [1]  01\n")

    def test_wrong_lines_of_json_are_named(self):
        for line, error in [
            ({"type": "Roio", "to": "arm"}, 'JSON field "message": missing'),
            ({"type": "Roio", "message": "angles"}, 'JSON field "to": missing'),
            ({"type": "Roio", "to": "leg", "message": "angles"}, 'JSON field "to": '),
            ({"type": "Roio", "to": "arm", "message": "walk"}, 'JSON field "message": '),
            ({"type": "Roio", "to": "arm", "message": "face", "fields": {"mood": 256}},
             'JSON field "fields": face.mood: 256; expected'),
            ({"type": "Roio", "to": "arm", "message": "face", "fields": {"mood": None}},
             'JSON field "fields.mood": null; expected'),
            ({"type": "Roio", "to": "arm", "message": "face", "fields": {"mood": 1}, "nose": 1},
             'JSON field "nose"'),
        ]:
            with self.subTest(error):
                status, _, said = self.run_cli("send", "-", stdin=json.dumps(line) + "\n")
                self.assertEqual(status, 1)
                self.assertTrue(said.startswith("roio-cli: line 1: " + error), said)


if __name__ == "__main__":
    main()
