#!/usr/bin/env python3
"""Makes the Arduino library: a zip with one folder, the same bytes from the same sources.

The include trees become one, src/, since that is the one folder Arduino looks into. A file that two
of them have is an error: one of the two would be lost.
"""
import argparse
import pathlib
import sys
import zipfile

OLDEST_TIME = (1980, 1, 1, 0, 0, 0)  # the files' own times would change the bytes


def files_below(folder):
    return sorted(path for path in folder.rglob("*") if path.is_file())


def merge(trees):
    """The files of all trees: path inside the tree -> file."""
    merged = {}
    clashes = []
    for tree in trees:
        for file in files_below(tree):
            name = file.relative_to(tree).as_posix()
            if name in merged:
                clashes.append(f"{name} is in {merged[name].parents[name.count('/')]} and in {tree}; "
                               "one of them needs another name")
            merged.setdefault(name, file)
    if clashes:
        sys.exit("arduino_library: " + "\narduino_library: ".join(clashes))
    return merged


def examples(folder):
    """Each sketch with what lies beside it."""
    return {file.relative_to(folder).as_posix(): file
            for sketch in sorted(folder.glob("*/*.ino"))
            for file in files_below(sketch.parent)}


def write_zip(path, entries):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as library:
        for name in sorted(entries):
            entry = zipfile.ZipInfo(name, OLDEST_TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3  # Unix, on any system
            entry.external_attr = 0o100644 << 16
            library.writestr(entry, entries[name].read_bytes())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("zip", type=pathlib.Path)
    parser.add_argument("--tree", action="append", required=True, type=pathlib.Path,
                        help="an include folder; again for more")
    parser.add_argument("--top", action="append", default=[], type=pathlib.Path,
                        help="a file for the library's top folder; again for more")
    parser.add_argument("--examples", type=pathlib.Path, help="a folder of sketch folders")
    arguments = parser.parse_args()

    entries = {f"Roio/{file.name}": file for file in arguments.top}
    for name, file in merge(arguments.tree).items():
        entries[f"Roio/src/{name}"] = file
    if arguments.examples:
        for name, file in examples(arguments.examples).items():
            entries[f"Roio/examples/{name}"] = file
    write_zip(arguments.zip, entries)


if __name__ == "__main__":
    main()
