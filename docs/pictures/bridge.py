"""The bridge: an Arduino as a PC's way to the bus, and roio-cli bridge attach, which lets many programs use it."""

from kit import Picture


def picture():
    p = Picture(880, 464, "The bridge",
                "Boards hang on a CAN bus. One of them, an Arduino with an MCP2515 module that runs bridge_usb, is joined "
                "to the PC by a USB cable. There roio-cli bridge attach /dev/ttyACM0 local:robot has the serial port and "
                "hands every frame on to the local bus, both ways, so that roio-cli, your program and roio-sim can all "
                "use it at once.")
    # the bus
    p.line([(80, 72), (80, 336)], "hot")
    for y in (72, 336):
        p.bar(68, y - 4, 24, 8, "dark", 2)
    p.text(80, 48, "CAN bus", "small muted", "middle")
    for y, name, address in ((104, "arm", "0.2"), (304, "sensors", "0.3")):
        p.line([(80, y), (112, y)], "hot")
        p.dot(80, y, "solid")
        p.titled(112, y - 32, 120, 64, name, [address])
    # the board
    p.line([(80, 204), (112, 204)], "hot")
    p.dot(80, 204, "solid")
    p.titled(112, 164, 120, 80, "Arduino", ["bridge_usb", "and MCP2515"], "tint")
    p.arrow([(232, 204), (324, 204)], both=True)
    p.text(268, 188, "USB", "small bold", "middle")
    p.text(268, 220, "serial line", "small muted", "middle")
    # the PC
    p.box(304, 32, 544, 344, "frame", 12)
    p.text(328, 60, "PC", "bold muted")
    p.titled(328, 164, 200, 80, "roio-cli bridge attach", ["one program has", "the serial port"], "tint", "bold small mono")
    p.arrow([(528, 204), (612, 204)], "hot", both=True)
    p.line([(616, 84), (616, 324)], "hot")
    p.text(616, 64, "local:robot", "small mono bold accent", "middle")
    for y, name, what, style in ((104, "roio-cli dump", "listens", "bold small mono"),
                                 (204, "your program", "C++ and libroio", "bold"),
                                 (304, "roio-sim", "more boards, simulated", "bold small mono")):
        p.line([(616, y), (656, y)], "hot")
        p.dot(616, y, "solid")
        p.titled(656, y - 32, 168, 64, name, [what], name_style=style)
    p.text(440, 408, "$ roio-cli bridge attach /dev/ttyACM0 local:robot", "mono bold", "middle")
    p.text(440, 436, "with vcan0 in place of local:robot: can-utils, and all else that knows SocketCAN", "small muted", "middle")
    return p
