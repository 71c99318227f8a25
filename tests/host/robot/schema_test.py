"""The JSON Schemas and docs/robot-file.md, against the reader: what is shipped passes, and of the files that the reader refuses (the tables
in refusals/, which refusal_test.cpp reads, too) the schemas refuse those of which a schema can know.

A row says "schema: refuses"; "accepts" where it is about values that stand in relation (a limit and a scale, two
names), or a number's form, which JSON Schema does not see; "none" where the text is no JSON for a schema to look at.
"""

import json
import os
import pathlib
import re
import unittest

import jsonschema

SOURCE = pathlib.Path(os.environ["ROIO_SOURCE"])


def validator(name):
    schema = json.loads((SOURCE / f"libroio/host/schema/{name}.schema.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def rows(name):
    """(why, what the schema says, text) of each row."""
    table = (SOURCE / f"tests/host/robot/refusals/{name}.txt").read_text(encoding="utf-8")
    for row in table.removeprefix("== ").split("\n== "):
        head, _, text = row.partition("\n--\n")
        why, *facts = head.split("\n")
        yield why, dict(fact.split(": ", 1) for fact in facts)["schema"], text


class Schemas(unittest.TestCase):
    def test_what_is_shipped_passes(self):
        for name, files in [("kind", SOURCE.glob("kinds/*.kind.json")),
                            ("kind", SOURCE.glob("tests/host/robot/*/*.kind.json")),
                            ("robot", SOURCE.glob("examples/*/robot.json")),
                            ("robot", SOURCE.glob("tests/host/robot/*/robot.json"))]:
            files = list(files)
            self.assertTrue(files, name)
            for file in files:
                with self.subTest(file=file):
                    validator(name).validate(json.loads(file.read_text(encoding="utf-8")))

    def test_what_the_reader_refuses(self):
        for name in ("kind", "robot"):
            schema = validator(name)
            refused = 0
            for why, says, text in rows(name):
                if says == "none":
                    continue
                with self.subTest(schema=name, why=why):
                    self.assertIn(says, ("refuses", "accepts"))
                    self.assertEqual(schema.is_valid(json.loads(text)), says == "accepts")
                    refused += says == "refuses"
            self.assertGreater(refused, 30)


class Document(unittest.TestCase):
    """The document's examples: files that the schemas pass, errors that the tables have."""

    def blocks(self, language):
        text = (SOURCE / "docs/robot-file.md").read_text(encoding="utf-8")
        found = re.findall(rf"(?ms)^```{language}\n(.*?)^```$", text)
        self.assertTrue(found)
        return found

    def test_its_files(self):
        for block in self.blocks("json"):
            file = json.loads(block)
            if "roio" not in file:  # a message
                continue
            with self.subTest(file=file):
                validator("kind" if "kind" in file else "robot").validate(file)

    def test_its_kind_is_the_one_that_is_installed(self):
        kind = json.loads(self.blocks("json")[0])
        shipped = json.loads((SOURCE / "kinds/servo-arm.kind.json").read_text(encoding="utf-8"))
        self.assertEqual((kind["hears"], list(kind["says"])), (shipped["hears"], list(shipped["says"])))

    def test_its_errors(self):
        tables = "".join((SOURCE / f"tests/host/robot/refusals/{name}.txt").read_text(encoding="utf-8")
                         for name in ("kind", "robot"))
        for line in self.blocks("text")[0].splitlines():
            with self.subTest(line=line):
                # Three dots stand for what depends on the machine.
                pattern = ".*".join(map(re.escape, line.split("...")))
                self.assertRegex(tables, rf"(?m)^error: {pattern}$")


unittest.main()
