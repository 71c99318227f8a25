#!/usr/bin/env python3
"""What the Arduino library's zip has to be: usage: check_library.py [Subject...]

The specification is https://docs.arduino.cc/arduino-cli/library-specification. The environment says
what to look at: ROIO_ZIP, ROIO_VERSION, ROIO_TREES (include folders, with ':' between), ROIO_EXAMPLES,
ROIO_COMMAND (makes the zip that is its last word; words with newlines between), CTAGS.
"""
import collections
import json
import os
import pathlib
import re
import subprocess
import tempfile
import unittest
import zipfile

zip_path = pathlib.Path(os.environ["ROIO_ZIP"])
version = os.environ["ROIO_VERSION"]
trees = [pathlib.Path(tree) for tree in os.environ["ROIO_TREES"].split(":")]
examples = pathlib.Path(os.environ["ROIO_EXAMPLES"])
command = os.environ["ROIO_COMMAND"].split("\n")

library = zipfile.ZipFile(zip_path)
names = library.namelist()


def text(name):
    return library.read(f"Roio/{name}").decode("ascii")


class Layout(unittest.TestCase):
    def test_one_folder_named_as_the_library(self):
        self.assertEqual({name.split("/")[0] for name in names}, {"Roio"})
        self.assertEqual(zip_path.name, f"Roio-{version}.zip")

    def test_files_alone(self):
        for entry in library.infolist():
            with self.subTest(entry.filename):
                self.assertEqual(entry.external_attr >> 16, 0o100644, "no link, no program")
                self.assertNotRegex(entry.filename, r"\\|(^|/)\.|^/|//|:")

    def test_names_differ_on_every_system(self):
        self.assertEqual(len({name.lower() for name in names}), len(names))

    def test_top_folder(self):
        top = {name.split("/")[1] for name in names}
        wanted = {"library.properties", "library.json", "keywords.txt", "LICENSE", "README.md", "src"}
        self.assertEqual(top - {"examples"}, wanted)
        self.assertEqual("examples" in top, any(examples.glob("*/*.ino")))

    def test_src_is_the_include_trees(self):
        in_zip = {name for name in names if name.startswith("Roio/src/")}
        in_trees = {}
        for tree in trees:
            for file in tree.rglob("*"):
                if file.is_file():
                    in_trees[f"Roio/src/{file.relative_to(tree).as_posix()}"] = file
        self.assertEqual(in_zip, set(in_trees))
        for name, file in in_trees.items():
            self.assertEqual(library.read(name), file.read_bytes(), name)

    def test_a_sketch_finds_all_headers(self):
        found = set()
        wanted = ["Roio.h"]
        while wanted:
            header = wanted.pop()
            if header not in found:
                found.add(header)
                wanted += re.findall(r"^ *# *include <(roio/.*)>", text(f"src/{header}"), re.MULTILINE)
        self.assertGreater(len(found), 10)

    def test_sketches_are_named_as_their_folders(self):
        sketches = [name for name in names if name.endswith(".ino")]
        self.assertEqual(len(sketches), len(list(examples.glob("*/*.ino"))))
        for sketch in sketches:
            self.assertRegex(sketch, r"^Roio/examples/(\w+)/\1\.ino$")


class Properties(unittest.TestCase):
    def setUp(self):
        lines = text("library.properties").splitlines()
        self.assertTrue(all("=" in line for line in lines))
        self.properties = dict(line.split("=", 1) for line in lines)
        self.assertEqual(len(self.properties), len(lines), "each key once")

    def test_all_that_the_specification_wants(self):
        # url may have no value as long as the project has no page; the IDE wants the key.
        self.assertIn("url", self.properties)
        self.assertRegex(self.properties["url"], r"^(https://.*)?$")
        for key in ("name", "version", "author", "maintainer", "sentence", "paragraph", "category",
                    "architectures", "includes", "license"):
            self.assertTrue(self.properties.get(key), key)

    def test_values(self):
        self.assertEqual(self.properties["name"], "Roio")
        self.assertEqual(self.properties["category"], "Communication")
        self.assertEqual(self.properties["architectures"], "*")
        self.assertEqual(self.properties["license"], "MIT")
        self.assertTrue(text("LICENSE").startswith("MIT License"))
        self.assertEqual(self.properties["includes"], "Roio.h")
        self.assertFalse(self.properties["paragraph"].startswith(self.properties["sentence"]),
                         "the IDE shows the paragraph after the sentence")

    def test_version_is_the_same_everywhere(self):
        parts = [re.search(rf"define ROIO_VERSION_{part} (\d+)", text("src/roio/version.hpp"))[1]
                 for part in ("MAJOR", "MINOR", "PATCH")]
        self.assertEqual(".".join(parts), version)
        self.assertEqual(self.properties["version"], version)
        self.assertEqual(json.loads(text("library.json"))["version"], version)


class PlatformIO(unittest.TestCase):
    """library.json, by https://docs.platformio.org/en/latest/manifests/library-json."""

    def test_manifest(self):
        manifest = json.loads(text("library.json"))
        self.assertEqual(set(manifest), {"name", "version", "description", "keywords", "authors",
                                         "license", "frameworks", "platforms", "headers"})
        self.assertEqual(manifest["name"], "Roio")
        self.assertLessEqual(len(manifest["description"]), 255)
        self.assertEqual(manifest["license"], "MIT")
        self.assertEqual(manifest["frameworks"], "arduino")
        self.assertEqual(manifest["headers"], "Roio.h")
        self.assertTrue(all(author["name"] for author in manifest["authors"]))
        for keyword in manifest["keywords"]:
            self.assertRegex(keyword, r"^[a-z0-9][a-z0-9\- ]*$")


class Tag(collections.namedtuple("Tag", "name kind fields")):
    @property
    def scope(self):
        """The class or enum that it is in, without namespaces."""
        for key in ("class", "struct", "enum"):
            if key in self.fields:
                return self.fields[key].split("::")[-1]
        return ""

    @property
    def bases(self):
        return re.findall(r"(?:\w+::)*(\w+)", without_arguments(self.fields.get("inherits", "")))


def without_arguments(template):
    """`roio::Node<Port<Pin>, int>` -> `roio::Node`."""
    return re.sub(r"<.*", "", template, flags=re.DOTALL).strip()


class Headers:
    """What class Roio offers, read from the headers in the zip."""

    def __init__(self):
        with tempfile.TemporaryDirectory() as folder:
            library.extractall(folder)
            source = pathlib.Path(folder) / "Roio/src"
            headers = sorted(source.rglob("*.h*"))
            self.code = "\n".join(header.read_text() for header in headers)
            for header in headers:  # ctags overlooks the member after `using Base::name;`
                header.write_text(re.sub(r"^ +using [^;]*;", "", header.read_text(), flags=re.MULTILINE))
            self.tags = list(self.read_tags(headers))
            self.top = list(self.read_tags([source / "Roio.h"]))

    @staticmethod
    def read_tags(files):
        words = [os.environ["CTAGS"], "-u", "--language-force=c++", "--c++-kinds=+pe",
                 "--fields=+akisS", "-f", "-"]
        output = subprocess.run(words + files, check=True, capture_output=True, text=True).stdout
        for line in output.splitlines():
            head, fields = line.split(';"\t')
            kind, *rest = fields.split("\t")
            yield Tag(head.split("\t")[0], kind, dict(field.split(":", 1) for field in rest))

    @staticmethod
    def top_aliases():
        return dict(re.findall(r"^using (\w+) =\s*([^;]+);", text("src/Roio.h"), re.MULTILINE))

    def classes(self):
        """What Roio and RoioOn are, and what these derive from."""
        bases = {tag.name: tag.bases for tag in self.tags if tag.kind in "cs"}
        wanted = [without_arguments(target).split("::")[-1]
                  for name, target in self.top_aliases().items() if name != "RoioOptions"]
        wanted += [tag.name for tag in self.top if tag.kind in "cs"]
        found = []
        while wanted:
            name = wanted.pop()
            if name not in found and name in bases:
                found.append(name)
                wanted += bases[name]
        return found

    def aliases(self):
        """Name -> what it stands for, of all `using X = ...;` that a sketch may use."""
        found = {}
        for name in self.classes():
            for body in re.findall(rf"^class {name}\b[^;]*?\{{\n(.*?)^\}};", self.code,
                                   re.DOTALL | re.MULTILINE):
                parts = re.split(r"^ (public|private|protected):\n", body, flags=re.MULTILINE)
                for access, part in zip(parts[1::2], parts[2::2]):
                    if access == "public":
                        found.update(re.findall(r"^  using (\w+) =\s*([^;]+);", part, re.MULTILINE))
        found.update(self.top_aliases())
        return found

    def types(self):
        return {tag.name for tag in self.top if tag.kind in "cs"} | set(self.aliases())

    def members(self):
        classes = self.classes()
        names = {tag.name for tag in self.tags
                 if tag.scope in classes and tag.kind in "fpm" and tag.fields.get("access") == "public"}
        # ctags takes what a constructor initialises for calls; such members end in '_'.
        return {name for name in names - set(classes)
                if not name.startswith(("~", "operator")) and not name.endswith("_")}

    def values(self):
        """Of the enums, but for MessageClass: its `message` is what sketches call their messages.
        And the constants of 2014."""
        enums = {target.split("::")[-1] for name, target in self.aliases().items()
                 if name != "MessageClass"}
        constants = {tag.name for tag in self.top if tag.kind == "v"}
        return constants | {tag.name for tag in self.tags if tag.kind == "e" and tag.scope in enums}


class Keywords(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.lines = [line for line in text("keywords.txt").splitlines()
                     if line and not line.startswith("#")]
        cls.headers = Headers()

    def of_kind(self, *kinds):
        return {line.split("\t")[0] for line in self.lines if line.split("\t")[1] in kinds}

    def test_one_tab(self):
        for line in self.lines:
            self.assertRegex(line, r"^[A-Za-z]\w*\t(KEYWORD1|KEYWORD2|LITERAL1)$")

    def test_each_name_once(self):
        found = [line.split("\t")[0] for line in self.lines]
        self.assertEqual([name for name, count in collections.Counter(found).items() if count > 1], [])

    def test_types(self):
        self.assertIn("Roio", self.headers.types())
        self.assertEqual(self.of_kind("KEYWORD1"), self.headers.types())

    def test_calls(self):
        self.assertIn("begin", self.headers.members())
        self.assertEqual(self.of_kind("KEYWORD2"), self.headers.members())

    def test_values(self):
        self.assertIn("ok", self.headers.values())
        self.assertEqual(self.of_kind("LITERAL1"), self.headers.values())


class Making(unittest.TestCase):
    def make(self, *more):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "made.zip"
            made = subprocess.run([*command, *more, path], capture_output=True, text=True)
            return made, path.read_bytes() if path.exists() else None

    def test_same_bytes_again(self):
        made, content = self.make()
        self.assertEqual(made.stderr, "")
        self.assertEqual(content, zip_path.read_bytes())

    def test_a_file_in_two_trees_fails(self):
        with tempfile.TemporaryDirectory() as folder:
            tree = pathlib.Path(folder) / "fourth"
            (tree / "roio").mkdir(parents=True)
            (tree / "roio/status.hpp").touch()
            (tree / "roio/fourth.hpp").touch()
            made, content = self.make("--tree", tree)
            first = next(tree for tree in trees if (tree / "roio/status.hpp").exists())
            self.assertEqual(made.stderr, f"arduino_library: roio/status.hpp is in {first} and in {tree}; "
                                          "one of them needs another name\n")
            self.assertNotEqual(made.returncode, 0)
            self.assertIsNone(content, "no zip without that file")


if __name__ == "__main__":
    unittest.main()
