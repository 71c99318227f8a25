#!/usr/bin/env python3
"""Builds one sketch for one board, with arduino-builder or arduino-cli.

  arduino_image.py SKETCH IMAGE --fqbn FQBN --builder ... (all tools named)
      The image goes to IMAGE and what the compilers said to a .log beside it. CMake builds so.

  arduino_image.py SKETCH [IMAGE] --board BOARD --library Roio-VERSION.zip
      A sketch of one's own. It finds the tools itself, and keeps images in a cache: what was built
      before, from the same sketch, library and tools, is not built again. Prints where the image is.
      roio-sim and scripts/flash build so.

  arduino_image.py --find SKETCH
      Prints the X/X.ino that is meant.

Exit status: 0, 1 when the sketch does not build, 2 for a sketch that is not there, 128+N after signal N.
"""
import argparse
import contextlib
import fcntl
import hashlib
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import zipfile

BOARDS = {
    "uno": "arduino:avr:uno",
    "nano": "arduino:avr:nano:cpu=atmega328",
    "leonardo": "arduino:avr:leonardo",
    "micro": "arduino:avr:micro",
    "mega": "arduino:avr:mega:cpu=atmega2560",
}
HARDWARE = pathlib.Path("/usr/share/arduino/hardware")
UNUSED_DAYS = 30  # so long an image stays in the cache that nobody asks for


class Refused(Exception):
    """What is wrong, in a line, and the exit status."""

    def __init__(self, text, status=1):
        super().__init__(text)
        self.status = status


class Interrupted(Exception):
    pass


def say(text):
    print(text, file=sys.stderr, flush=True)


# --- how arduino-builder and arduino-cli are asked ----------------------------------------------------

def preferences(tools):
    """What the Arduino IDE would know by itself, and arduino-builder is to be told."""
    ctags = ('"{cmd.path}" -u --language-force=c++ -f - --c++-kinds=svpf --fields=KSTtzns '
             '--line-directives "{source_file}"')
    return {
        "runtime.tools.avr-gcc.path": tools.toolchain,
        "tools.ctags.cmd.path": tools.ctags,
        "tools.ctags.pattern": ctags,
        # Arduino's core (WString.cpp) wants this macro; the <float.h> of gcc 5.4 has it for C alone.
        "compiler.cpp.extra_flags": "-DDECIMAL_DIG=__DECIMAL_DIG__",
    }


def builder_command(tools, sketch, fqbn, work, core_cache, libraries, warnings):
    words = [tools.builder, "-compile", f"-warnings={warnings}", "-core-api-version=10819",
             "-hardware", tools.hardware, "-tools", work / "tools", "-fqbn", fqbn,
             "-build-path", work / "build", "-build-cache", core_cache]
    if libraries:
        words += ["-libraries", libraries]
    for key, value in preferences(tools).items():
        words += ["-prefs", f"{key}={value}"]
    return words + [sketch]


def cli_command(tools, sketch, fqbn, work, libraries):
    return [tools.cli, "compile", "--fqbn", fqbn, "--libraries", libraries, "--build-path",
            work / "build", "--warnings", "none", sketch.parent]


def run(command):
    """(exit status, all that was said). Whoever ends this program ends the compilers, too."""
    process = subprocess.Popen([str(word) for word in command], stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                               errors="replace", start_new_session=True)
    try:
        said = process.communicate()[0]
    except BaseException:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        raise
    return process.returncode, said


def empty_folders(work, cache):
    shutil.rmtree(work, ignore_errors=True)
    for folder in (work / "tools", work / "build", cache):
        folder.mkdir(parents=True, exist_ok=True)


# --- an image for CMake -------------------------------------------------------------------------------

def sizes(size_program, image):
    """(flash, static RAM) in bytes."""
    lines = subprocess.run([size_program, image], check=True, capture_output=True, text=True)
    text, data, bss = (int(word) for word in lines.stdout.splitlines()[1].split()[:3])
    return text + data, data + bss


def build_image(arguments):
    work = arguments.image.with_suffix(".build")
    log = arguments.image.with_suffix(".log")
    # What a former build left could hide a failure, a warning, or a header that is new.
    arguments.image.unlink(missing_ok=True)
    empty_folders(work, arguments.cache)
    status, said = run(builder_command(arguments, arguments.sketch.resolve(), arguments.fqbn, work,
                                       arguments.cache, arguments.libraries, "all"))
    log.write_text(said)
    if status != 0:
        raise Refused(f"{said}\narduino_image: {arguments.sketch} does not build for {arguments.fqbn}")
    (work / "build" / f"{arguments.sketch.name}.elf").replace(arguments.image)
    flash, ram = sizes(arguments.size, arguments.image)
    print(f"{arguments.image.parent.name}/{arguments.image.name}: {flash} bytes of flash, {ram} of RAM")
    shutil.rmtree(work)


# --- the tools of a sketch of one's own ---------------------------------------------------------------

class Tools:
    """Either `builder` with what it needs, or `cli`, which has it all."""

    def __init__(self, hardware):
        self.hardware = hardware
        self.builder = shutil.which("arduino-builder")
        self.cli = None if self.builder else shutil.which("arduino-cli")
        self.ctags = shutil.which("arduino-ctags")
        self.compiler = shutil.which("avr-g++")
        if not self.cli:
            self.check()
            self.toolchain = pathlib.Path(self.compiler).parent.parent

    def check(self):
        boards = self.hardware / "arduino/avr/boards.txt"
        # Where Debian has it; a compiler from elsewhere brings its own.
        own_libc = self.compiler != "/usr/bin/avr-g++" or pathlib.Path("/usr/lib/avr/include/avr/io.h").exists()
        missing = [package for package, there in (
            ("arduino-builder", self.builder), ("arduino-ctags", self.ctags),
            ("arduino-core-avr", boards.exists()), ("gcc-avr", self.compiler),
            ("avr-libc", own_libc)) if not there]
        if missing:
            raise Refused(f"{'arduino-builder' if not self.builder else missing[0]} is missing, which builds "
                          f"sketches; on Debian: sudo apt-get install --no-install-recommends {' '.join(missing)}")

    def identity(self):
        """Changes when one of them does."""
        files = [self.cli] if self.cli else [
            self.builder, self.ctags, self.compiler, self.hardware / "arduino/avr/boards.txt"]
        return [f"{file} {os.stat(file).st_size} {os.stat(file).st_mtime_ns}" for file in files]


# --- a sketch of one's own ----------------------------------------------------------------------------

def find_sketch(path):
    """X/X.ino, from that or from its folder."""
    if path.is_dir():
        folder = path.resolve()
        sketch = folder / f"{folder.name}.ino"
        if not sketch.is_file():
            raise Refused(f"{path}: expected the sketch {folder.name}.ino in this folder", 2)
        return sketch
    if not path.is_file():
        raise Refused(f"{path}: no such file", 2)
    sketch = path.resolve()
    if sketch.parent.name != sketch.stem:
        raise Refused(f"{path}: expected it in a folder of its name, {sketch.stem}/{sketch.name}", 2)
    return sketch


def digest(arguments, sketch, tools):
    """Another one when anything has changed that the image is made of."""
    sum_ = hashlib.sha256()

    def add(name, data):
        sum_.update(f"{name} {len(data)}\n".encode())
        sum_.update(data)

    add("board", arguments.board.encode())
    add("script", pathlib.Path(__file__).read_bytes())
    add("library", arguments.library.read_bytes())
    for line in tools.identity():
        add("tool", line.encode())
    for folder, folders, names in os.walk(sketch.parent):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in sorted(name for name in names if not name.startswith(".")):
            file = pathlib.Path(folder, name)
            if file.is_file():
                add(file.relative_to(sketch.parent).as_posix(), file.read_bytes())
    return sum_.hexdigest()[:20]


@contextlib.contextmanager
def locked(path, tool):
    """One build at a time: two that find no core in the cache would write it at once."""
    with open(path, "w") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            say(f"{tool}: waiting until another sketch is built ...")
            fcntl.flock(file, fcntl.LOCK_EX)
        yield


def remove_unused(cache, kept):
    """Images nobody has asked for in a long time, and what builds left that were killed."""
    for path in [*cache.glob("*/*.elf"), *cache.glob("build-*")]:
        with contextlib.suppress(OSError):
            days = (time.time() - path.stat().st_mtime) / 86400
            if path != kept and days > (UNUSED_DAYS if path.suffix == ".elf" else 1):
                shutil.rmtree(path) if path.is_dir() else path.unlink()


def compile_sketch(arguments, sketch, tools, cache, image):
    before = digest(arguments, sketch, tools)
    work = pathlib.Path(tempfile.mkdtemp(prefix="build-", dir=cache))
    try:
        (work / "tools").mkdir()
        (work / "build").mkdir()
        core_cache = cache / "core" / arguments.board
        core_cache.mkdir(parents=True, exist_ok=True)
        zipfile.ZipFile(arguments.library).extractall(work / "libraries")
        fqbn = BOARDS[arguments.board]
        status, said = run(
            cli_command(tools, sketch, fqbn, work, work / "libraries") if tools.cli else
            builder_command(tools, sketch, fqbn, work, core_cache, work / "libraries", "none"))
        built = work / "build" / f"{sketch.name}.elf"
        if status != 0 or not built.exists():
            say("\n".join(line for line in said.splitlines() if not line.startswith("exit status ")))
            raise Refused(f"{arguments.sketch} does not build for {arguments.board}")
        if digest(arguments, sketch, tools) != before:
            raise Refused(f"{arguments.sketch}: was changed while it was built; try again")
        built.replace(image)
    finally:
        shutil.rmtree(work, ignore_errors=True)


def cache_folder():
    # The specification of base directories: what is not absolute counts as not set.
    base = os.environ.get("XDG_CACHE_HOME", "")
    return (pathlib.Path(base) if base.startswith("/") else pathlib.Path.home() / ".cache") / "roio"


def build_own(arguments):
    sketch = find_sketch(arguments.sketch)
    tools = Tools(arguments.hardware or HARDWARE)
    cache = arguments.cache or cache_folder()
    images = cache / arguments.board
    images.mkdir(parents=True, exist_ok=True)
    with locked(cache / f"{arguments.board}.lock", arguments.tool):
        image = images / f"{sketch.stem}-{digest(arguments, sketch, tools)}.elf"
        if not image.exists():
            say(f"{arguments.tool}: building {sketch.stem} for {arguments.board} ...")
            compile_sketch(arguments, sketch, tools, cache, image)
        os.utime(image)
        remove_unused(cache, image)
        if arguments.image:
            arguments.image.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(image, arguments.image)
    print(arguments.image or image)


# --- which --------------------------------------------------------------------------------------------

def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sketch", type=pathlib.Path, help="X/X.ino; with --board its folder, too")
    parser.add_argument("image", type=pathlib.Path, nargs="?", help="the .elf to write")
    parser.add_argument("--board", choices=BOARDS, help="for a sketch of one's own")
    parser.add_argument("--library", type=pathlib.Path, help="Roio-VERSION.zip, for a sketch of one's own")
    parser.add_argument("--find", action="store_true", help="build nothing")
    parser.add_argument("--tool", default="arduino_image", help="under which name it says something")
    parser.add_argument("--fqbn", help="the board, e.g. arduino:avr:uno")
    parser.add_argument("--builder", help="arduino-builder")
    parser.add_argument("--ctags", help="arduino-ctags")
    parser.add_argument("--size", help="avr-size")
    parser.add_argument("--toolchain", help="the folder whose bin/ has avr-gcc")
    parser.add_argument("--hardware", type=pathlib.Path, help="the folder that has arduino/avr")
    parser.add_argument("--libraries", help="a folder of unpacked libraries")
    parser.add_argument("--cache", type=pathlib.Path,
                        help="keeps the compiled core; without --board, two builds may share it once the core "
                             "is there")
    arguments = parser.parse_args()
    needed = [] if arguments.find else ["library"] if arguments.board else [
        "image", "fqbn", "builder", "ctags", "size", "toolchain", "hardware", "cache"]
    for name in needed:
        if getattr(arguments, name) is None:
            parser.error(f"expected {name}, too")
    return arguments


def catch_signals():
    def interrupt(number, _frame):
        for each in (signal.SIGINT, signal.SIGTERM):
            signal.signal(each, signal.SIG_IGN)  # what follows is cleaning up
        raise Interrupted(number)

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, interrupt)


def main():
    arguments = parse()
    catch_signals()
    try:
        if arguments.find:
            print(find_sketch(arguments.sketch))
        elif arguments.board:
            build_own(arguments)
        else:
            build_image(arguments)
    except Refused as error:
        say(f"{arguments.tool}: {error}" if arguments.board or arguments.find else error)
        return error.status
    except OSError as error:
        say(f"{arguments.tool}: {error.filename}: {error.strerror}" if error.filename else
            f"{arguments.tool}: {error}")
        return 1
    except (RuntimeError, zipfile.BadZipFile) as error:  # no home; no library
        say(f"{arguments.tool}: {error}")
        return 1
    except Interrupted as interrupted:
        return 128 + interrupted.args[0]
    return 0


if __name__ == "__main__":
    sys.exit(main())
