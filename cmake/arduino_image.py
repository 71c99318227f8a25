#!/usr/bin/env python3
"""Builds one sketch for one board with arduino-builder, and leaves its ELF image and a log.

The log holds all that the builder and the compilers said, warnings included.
"""
import argparse
import pathlib
import shutil
import subprocess
import sys


def preferences(arguments):
    """What the Arduino IDE would know by itself, and arduino-builder is to be told."""
    ctags = ('"{cmd.path}" -u --language-force=c++ -f - --c++-kinds=svpf --fields=KSTtzns '
             '--line-directives "{source_file}"')
    return {
        "runtime.tools.avr-gcc.path": arguments.toolchain,
        "tools.ctags.cmd.path": arguments.ctags,
        "tools.ctags.pattern": ctags,
        # Arduino's core (WString.cpp) wants this macro; the <float.h> of gcc 5.4 has it for C alone.
        "compiler.cpp.extra_flags": "-DDECIMAL_DIG=__DECIMAL_DIG__",
    }


def command(arguments, work):
    words = [arguments.builder, "-compile", "-warnings=all", "-core-api-version=10819",
             "-hardware", arguments.hardware, "-tools", work / "tools", "-fqbn", arguments.fqbn,
             "-build-path", work / "build", "-build-cache", arguments.cache]
    if arguments.libraries:
        words += ["-libraries", arguments.libraries]
    for key, value in preferences(arguments).items():
        words += ["-prefs", f"{key}={value}"]
    return [str(word) for word in words + [arguments.sketch.resolve()]]


def empty_folders(work, cache):
    shutil.rmtree(work, ignore_errors=True)
    for folder in (work / "tools", work / "build", cache):
        folder.mkdir(parents=True, exist_ok=True)


def sizes(size_program, image):
    """(flash, static RAM) in bytes."""
    lines = subprocess.run([size_program, image], check=True, capture_output=True, text=True)
    text, data, bss = (int(word) for word in lines.stdout.splitlines()[1].split()[:3])
    return text + data, data + bss


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sketch", type=pathlib.Path, help="X/X.ino")
    parser.add_argument("image", type=pathlib.Path, help="the .elf to write; its log lies beside it")
    parser.add_argument("--fqbn", required=True, help="the board, e.g. arduino:avr:uno")
    parser.add_argument("--builder", required=True, help="arduino-builder")
    parser.add_argument("--ctags", required=True, help="arduino-ctags")
    parser.add_argument("--size", required=True, help="avr-size")
    parser.add_argument("--toolchain", required=True, help="the folder whose bin/ has avr-gcc")
    parser.add_argument("--hardware", required=True, help="the folder that has arduino/avr")
    parser.add_argument("--libraries", help="a folder of unpacked libraries")
    parser.add_argument("--cache", required=True, type=pathlib.Path,
                        help="keeps the compiled core; two builds may share it once the core is there")
    arguments = parser.parse_args()

    work = arguments.image.with_suffix(".build")
    log = arguments.image.with_suffix(".log")
    # What a former build left could hide a failure, a warning, or a header that is new.
    arguments.image.unlink(missing_ok=True)
    empty_folders(work, arguments.cache)
    built = subprocess.run(command(arguments, work), stdout=subprocess.PIPE,
                           stderr=subprocess.STDOUT, text=True)
    log.write_text(built.stdout)
    if built.returncode != 0:
        sys.exit(f"{built.stdout}\narduino_image: {arguments.sketch} does not build for "
                 f"{arguments.fqbn}")
    (work / "build" / f"{arguments.sketch.name}.elf").replace(arguments.image)
    flash, ram = sizes(arguments.size, arguments.image)
    print(f"{arguments.image.parent.name}/{arguments.image.name}: {flash} bytes of flash, {ram} of RAM")
    shutil.rmtree(work)


if __name__ == "__main__":
    main()
