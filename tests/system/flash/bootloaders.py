"""The bootloaders of Arduino boards, from the side of the one who programs: each a pseudo terminal that
answers as the real one does, and keeps what was written.

Optiboot       STK500 version 1 (Atmel AVR061), as Uno and Nano have it
Stk500v2       version 2 (AVR068), the Mega's
Caterina       AVR109, of Leonardo and Micro, on a port that appears when the sketch's was closed at 1200 bit/s
"""

import os
import pty
import termios
import threading
import time
import tty


class Terminal:
    """A pseudo terminal with a thread that serves it until its program is gone."""

    def __init__(self):
        self.master, slave = pty.openpty()
        tty.setraw(slave)
        self.path = os.ttyname(slave)
        self.slave = slave
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        try:
            self.serve()
        except OSError:
            pass  # closed

    def read(self, count):
        data = b""
        while len(data) < count:
            data += os.read(self.master, count - len(data))
        return data

    def write(self, data):
        os.write(self.master, bytes(data))

    def rate(self):
        return termios.tcgetattr(self.master)[5]

    def close(self):
        for descriptor in (self.slave, self.master):
            if descriptor is not None:
                os.close(descriptor)
        self.slave = self.master = None


class Bootloader(Terminal):
    def __init__(self, signature, rate):
        self.signature = signature
        self.expected_rate = rate
        self.flash = {}  # by address in bytes
        self.done = False
        super().__init__()

    def keep(self, address, data):
        self.flash.update(enumerate(data, address))

    def kept(self, address, count):
        return bytes(self.flash.get(i, 0xFF) for i in range(address, address + count))

    def image(self):
        return self.kept(0, max(self.flash) + 1) if self.flash else b""


class Optiboot(Bootloader):
    ANSWERS = {0x42: 20, 0x45: 5, 0x50: 0, 0x56: 4, 0x30: 0}  # of no consequence; their arguments

    def serve(self):
        address = 0
        while not self.done:
            command = self.read(1)[0]
            assert self.rate() == self.expected_rate
            answer = b""
            if command == 0x41:  # a parameter
                self.read(1)
                answer = b"\x03"
            elif command == 0x75:
                answer = self.signature
            elif command == 0x55:
                address = 2 * int.from_bytes(self.read(2), "little")
            elif command == 0x64:
                self.keep(address, self.read(int.from_bytes(self.read(3)[:2], "big")))
            elif command == 0x74:
                answer = self.kept(address, int.from_bytes(self.read(3)[:2], "big"))
            elif command == 0x51:
                self.done = True
            else:
                self.read(self.ANSWERS[command])
                answer = b"\x00" if command == 0x56 else b""
            assert self.read(1) == b"\x20"
            self.write(b"\x14" + answer + b"\x10")


class Stk500v2(Bootloader):
    def serve(self):
        self.address = 0
        while not self.done:
            start, sequence, high, low, token = self.read(5)
            assert (start, token) == (0x1B, 0x0E) and self.rate() == self.expected_rate
            body = self.read(high << 8 | low)
            self.read(1)  # the sum: a pseudo terminal damages nothing
            answer = bytes([body[0], 0]) + self.answer(body)
            message = bytes([0x1B, sequence]) + len(answer).to_bytes(2, "big") + b"\x0e" + answer
            total = 0
            for byte in message:
                total ^= byte
            self.write(message + bytes([total]))

    def answer(self, body):
        command = body[0]
        size = int.from_bytes(body[1:3], "big")
        if command == 0x01:
            return b"\x08AVRISP_2"
        if command == 0x03:
            return b"\x02"
        if command == 0x06:
            self.address = 2 * (int.from_bytes(body[1:5], "big") & 0x7FFFFFFF)
        elif command == 0x13:
            self.keep(self.address, body[10:10 + size])
            self.address += size
        elif command == 0x14:
            self.address += size
            return self.kept(self.address - size, size) + b"\x00"
        elif command == 0x1B:
            return bytes([self.signature[body[4]], 0])
        elif command == 0x1D:  # SPI as an AVR's programmer does it; of no consequence
            return bytes(5)
        elif command == 0x11:
            self.done = True
        return b""


class Caterina(Bootloader):
    def serve(self):
        address = 0
        while not self.done:
            command = chr(self.read(1)[0])
            if command in "SVvpabtsFNQr":
                self.write({"S": b"CATERIN", "V": b"10", "v": b"?", "p": b"S", "a": b"Y", "b": b"Y\x00\x80",
                            "t": b"\x44\x00", "s": self.signature[::-1]}.get(command, b"\xff"))
            elif command == "g":
                size = int.from_bytes(self.read(3)[:2], "big")
                self.write(self.kept(address, size))
                address += size
            else:
                if command == "A":
                    address = 2 * int.from_bytes(self.read(2), "big")
                elif command == "B":
                    data = self.read(int.from_bytes(self.read(3)[:2], "big"))
                    self.keep(address, data)
                    address += len(data)
                elif command in "Txy":
                    self.read(1)
                self.done = command == "E"
                self.write(b"\r")


class TouchedPort(Terminal):
    """The port of a running sketch: closed at 1200 bit/s, it disappears, and the bootloader's is there."""

    def __init__(self, folder, before, after, bootloader):
        self.before, self.after = (os.path.join(folder, name) for name in (before, after))
        self.bootloader = bootloader
        super().__init__()
        os.symlink(self.path, self.before)
        os.close(self.slave)  # so that who opens it is the last to close it
        self.slave = None

    def serve(self):
        while self.rate() != termios.B1200:
            time.sleep(0.01)
        while True:
            try:
                self.read(1)
            except OSError:  # closed
                break
        os.unlink(self.before)
        time.sleep(0.3)
        os.symlink(self.bootloader.path, self.after)
